#include "spirv_interp/ir/parse.h"

#include <charconv>
#include <optional>

#include "spirv_interp/ir/names.h"
#include "spirv_interp/ir/ops.h"

namespace vernier::ir {
namespace {

// Bounds on the numbers of a text, so that a short text cannot ask for much memory.
constexpr uint64_t kMaxValues = 1u << 24, kMaxBlocks = 1u << 20;

/// One line, read token by token. After a failure every read gives 0 and `failed` says what was expected.
class LineReader {
  public:
    explicit LineReader(std::string_view line) : rest_(line.substr(0, line.find(';'))) { skip(); }

    bool done() const { return rest_.empty(); }
    bool failed() const { return expected_ != nullptr; }
    const char* expected() const { return expected_; }
    void fail(const char* expected) {
        if (expected_ == nullptr) expected_ = expected;
    }
    bool accept(std::string_view text) {
        if (!rest_.starts_with(text)) return false;
        rest_.remove_prefix(text.size());
        skip();
        return true;
    }
    /// Like accept for a whole word.
    bool acceptWord(std::string_view word) {
        if (!rest_.starts_with(word) || (rest_.size() > word.size() && isWord(rest_[word.size()]))) return false;
        return accept(word);
    }
    void expect(std::string_view text, const char* expected) {
        if (!accept(text)) fail(expected);
    }
    std::string_view word() {
        size_t length = 0;
        while (length < rest_.size() && isWord(rest_[length])) ++length;
        const std::string_view result = rest_.substr(0, length);
        if (length == 0) fail("a word");
        rest_.remove_prefix(length);
        skip();
        return result;
    }
    uint64_t number(uint64_t maximum) {
        uint64_t value = 0;
        const bool hex = rest_.starts_with("0x");
        const char* first = rest_.data() + (hex ? 2 : 0);
        const auto [end, code] = std::from_chars(first, rest_.data() + rest_.size(), value, hex ? 16 : 10);
        if (code != std::errc() || value > maximum) {
            fail("a number in range");
            return 0;
        }
        rest_.remove_prefix(static_cast<size_t>(end - rest_.data()));
        skip();
        return value;
    }
    int32_t signedNumber() {
        int32_t value = 0;
        const auto [end, code] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
        if (code != std::errc()) {
            fail("a signed number");
            return 0;
        }
        rest_.remove_prefix(static_cast<size_t>(end - rest_.data()));
        skip();
        return value;
    }
    std::string quoted() {
        const size_t end = rest_.size() > 1 && rest_[0] == '"' ? rest_.find('"', 1) : std::string_view::npos;
        if (end == std::string_view::npos) {
            fail("a quoted name");
            return {};
        }
        const std::string result(rest_.substr(1, end - 1));
        rest_.remove_prefix(end + 1);
        skip();
        return result;
    }
    template <class Enum>
    Enum name(const char* expected) {
        const std::optional<Enum> value = fromName<Enum>(word());
        if (!value) fail(expected);
        return value.value_or(Enum{});
    }
    bool atValue() const { return rest_.starts_with('%'); }
    bool atBlock() const { return rest_.size() > 1 && rest_[0] == 'b' && rest_[1] >= '0' && rest_[1] <= '9'; }
    ValueId value() {
        expect("%", "a value");
        return static_cast<ValueId>(number(kMaxValues));
    }
    BlockId block() {
        expect("b", "a block");
        return static_cast<BlockId>(number(kMaxBlocks));
    }

  private:
    static bool isWord(char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    }
    void skip() {
        while (!rest_.empty() && (rest_[0] == ' ' || rest_[0] == '\t' || rest_[0] == '\r')) rest_.remove_prefix(1);
    }

    std::string_view rest_;
    const char* expected_ = nullptr;
};

class Parser {
  public:
    Result<Program> run(std::string_view text) {
        size_t number = 0;
        while (!text.empty()) {
            const size_t end = text.find('\n');
            LineReader in(text.substr(0, end));
            text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
            ++number;
            if (in.done()) continue;
            line(in);
            if (!in.failed() && !in.done()) in.fail("the end of the line");
            if (in.failed()) {
                return invalidArgument("IR text, line " + std::to_string(number) + ": expected " + in.expected());
            }
        }
        return std::move(program_);
    }

  private:
    Program program_;

    void line(LineReader& in) {
        if (in.acceptWord("program")) {
            program_.stage = in.name<Stage>("a stage");
            program_.name = in.quoted();
        } else if (in.acceptWord("input")) {
            slot(in, program_.inputs);
        } else if (in.acceptWord("output")) {
            slot(in, program_.outputs);
        } else if (in.acceptWord("resource")) {
            resource(in);
        } else if (in.acceptWord("file")) {
            index(in, program_.files.size());
            program_.files.push_back(in.quoted());
        } else if (in.acceptWord("imageOp")) {
            imageOp(in);
        } else if (in.acceptWord("facts")) {
            while (!in.failed() && !in.done()) fact(in);
        } else if (in.acceptWord("localSize")) {
            for (uint32_t& size : program_.localSize) size = static_cast<uint32_t>(in.number(~0u));
        } else if (in.acceptWord("geometry")) {
            geometry(in);
        } else if (in.acceptWord("local")) {
            program_.localWords = static_cast<uint32_t>(in.number(~0u));
        } else if (in.atBlock()) {
            blockHead(in);
        } else {
            instruction(in);
        }
    }

    void geometry(LineReader& in) {
        program_.geometry.input = in.name<GeometryInput>("a primitive that goes in");
        program_.geometry.output = in.name<GeometryOutput>("a primitive that comes out");
        in.expect("invocations", "the number of invocations");
        program_.geometry.invocations = static_cast<uint32_t>(in.number(~0u));
        in.expect("vertices", "the number of vertices");
        program_.geometry.outputVertices = static_cast<uint32_t>(in.number(~0u));
    }

    void index(LineReader& in, size_t next) {
        if (in.number(~0u) != next) in.fail("the next number in the list");
    }

    void slot(LineReader& in, std::vector<InterfaceSlot>& slots) {
        index(in, slots.size());
        InterfaceSlot& slot = slots.emplace_back();
        slot.type = type(in);
        slot.builtin = in.name<Builtin>("a builtin");
        slot.location = static_cast<uint16_t>(in.number(0xFFFF));
        in.expect(".", "'.'");
        slot.component = static_cast<uint8_t>(in.number(0xFF));
        if (in.accept(".")) slot.index = static_cast<uint8_t>(in.number(0xFF));
        if (in.done()) return;
        slot.interpolation = in.name<Interpolation>("an interpolation");
        slot.sampling = in.name<Sampling>("a sampling");
    }

    void resource(LineReader& in) {
        index(in, program_.resources.size());
        Resource& r = program_.resources.emplace_back();
        r.kind = in.name<ResourceKind>("a kind of resource");
        r.set = static_cast<uint32_t>(in.number(~0u));
        in.expect(".", "'.'");
        r.binding = static_cast<uint32_t>(in.number(~0u));
        in.expect("x", "'x'");
        r.arraySize = static_cast<uint32_t>(in.number(~0u));
        if (in.acceptWord("bytes")) r.byteSize = static_cast<uint32_t>(in.number(~0u));
        r.aliased = in.acceptWord("aliased");
        r.readOnly = in.acceptWord("read");
    }

    void imageOp(LineReader& in) {
        index(in, program_.imageOps.size());
        ImageOp& op = program_.imageOps.emplace_back();
        op.kind = in.name<ImageKind>("a kind of image operation");
        op.dim = in.name<ImageDim>("a dimension");
        in.expect("image", "'image'");
        op.imageResource = static_cast<uint32_t>(in.number(~0u));
        if (in.acceptWord("sampler")) op.samplerResource = static_cast<uint32_t>(in.number(~0u));
        const auto counted = [&in](const char* word) {
            return in.acceptWord(word) ? static_cast<uint8_t>(in.number(0xFF)) : uint8_t{0};
        };
        op.coords = counted("coords");
        op.gradients = counted("gradients");
        op.offsets = counted("offsets");
        op.component = counted("component");
        op.arrayed = in.acceptWord("arrayed");
        op.multisampled = in.acceptWord("multisampled");
        op.depthCompare = in.acceptWord("depthCompare");
        op.hasBias = in.acceptWord("bias");
        op.hasLod = in.acceptWord("lod");
        op.hasSample = in.acceptWord("sample");
        op.hasMinLod = in.acceptWord("minLod");
        if (op.kind == ImageKind::atomic) op.atomicOp = in.name<AtomicOp>("an atomic operation");
    }

    void fact(LineReader& in) {
        const std::pair<std::string_view, bool*> facts[] = {{"earlyFragmentTests", &program_.earlyFragmentTests},
                                                            {"postDepthCoverage", &program_.postDepthCoverage},
                                                            {"usesQuads", &program_.usesQuads},
                                                            {"canDiscard", &program_.canDiscard},
                                                            {"writesDepth", &program_.writesDepth},
                                                            {"writesSampleMask", &program_.writesSampleMask},
                                                            {"hasSideEffects", &program_.hasSideEffects},
                                                            {"perSample", &program_.perSample},
                                                            {"hasBarriers", &program_.hasBarriers},
                                                            {"usesSubgroups", &program_.usesSubgroups}};
        const std::string_view word = in.word();
        for (const auto& [name, flag] : facts) {
            if (name != word) continue;
            *flag = true;
            return;
        }
        in.fail("a fact");
    }

    void blockHead(LineReader& in) {
        if (in.block() != program_.blocks.size()) in.fail("the next block");
        Block& block = program_.blocks.emplace_back();
        if (in.acceptWord("loop")) {
            block.loopHeader = true;
            block.loopEnd = in.block();
        }
        if (in.accept("<-")) {
            while (in.atBlock()) block.predecessors.push_back(in.block());
        }
        in.expect(":", "':'");
    }

    Type type(LineReader& in) {
        const std::optional<Type> type = typeFromName(in.word());
        if (!type) in.fail("a type");
        return type.value_or(Type::none);
    }

    void instruction(LineReader& in) {
        if (program_.blocks.empty()) return in.fail("a block before the first instruction");
        Block& block = program_.blocks.back();
        Inst inst;
        if (in.atValue()) {
            inst.result = in.value();
            if (in.accept("..")) in.value();
            inst.type = type(in);
            in.expect("=", "'='");
        }
        std::string_view name = in.word();
        if (const std::optional<Type> typed = typeFromName(name)) {
            inst.type = *typed;
            in.expect("=", "'='");
            name = in.word();
        }
        const std::optional<Op> op = opFromName(name);
        if (!op) return in.fail("an operation");
        inst.op = *op;
        if ((opInfo(*op).results != 0) != (inst.result != kNoValue))
            return in.fail("as many results as the operation has");
        immediate(in, inst);
        inst.firstOperand = static_cast<uint32_t>(program_.operands.size());
        while (in.atValue() && program_.operands.size() - inst.firstOperand < 0xFFFF) {
            program_.operands.push_back(in.value());
        }
        inst.operandCount = static_cast<uint16_t>(program_.operands.size() - inst.firstOperand);
        if (opInfo(*op).kind == 'T') targets(in, block);
        inst.noContraction = in.acceptWord("!noContraction");
        inst.relaxed = in.acceptWord("!relaxed");
        if (in.accept("@")) {
            inst.line = static_cast<uint32_t>(in.number(~0u));
            if (in.accept(":")) inst.file = static_cast<uint32_t>(in.number(~0u));
        }
        if (in.failed()) return;
        for (uint32_t r = 0; r < opInfo(*op).results; ++r) {
            const size_t value = static_cast<size_t>(inst.result) + r;
            if (value >= program_.valueTypes.size()) program_.valueTypes.resize(value + 1, Type::none);
            program_.valueTypes[value] = inst.type;
        }
        block.insts.push_back(inst);
    }

    void immediate(LineReader& in, Inst& inst) {
        switch (immKind(inst.op)) {
            case ImmKind::none:
                return;
            case ImmKind::bits:
                inst.imm = in.number(~0ull);
                return;
            case ImmKind::type:
                in.expect(".", "the type of the operands");
                inst.imm = static_cast<uint64_t>(type(in));
                return;
            case ImmKind::pair: {
                in.expect("#", "'#'");
                const auto low = static_cast<uint32_t>(in.number(~0u));
                in.expect(":", "':'");
                inst.imm = immPair(low, static_cast<uint32_t>(in.number(~0u)));
                return;
            }
            case ImmKind::resource: {
                in.expect("#", "'#'");
                const auto low = in.acceptWord("any") ? kNoIndex : static_cast<uint32_t>(in.number(~0u));
                inst.imm = immPair(low, in.accept(":") ? static_cast<uint32_t>(in.number(~0u)) : 0);
                return;
            }
            default:
                in.expect("#", "'#'");
                inst.imm = in.number(~0u);
                return;
        }
    }

    void targets(LineReader& in, Block& block) {
        while (!in.failed()) {
            if (in.atBlock()) {
                block.successors.push_back(in.block());
            } else if (in.accept("[")) {
                block.cases.push_back(in.signedNumber());
                in.expect(":", "':'");
                block.successors.push_back(in.block());
                in.expect("]", "']'");
            } else {
                return;
            }
        }
    }
};

}  // namespace

Result<Program> parse(std::string_view text) {
    return Parser().run(text);
}

}  // namespace vernier::ir
