// Recording: a linear stream of plain structs in an arena. No virtual calls, no allocation per command.
#pragma once

#include <span>

#include "base/arena.h"
#include "runtime/command/commands.h"

namespace vernier {

struct CommandHeader {
    const CommandHeader* next = nullptr;
    CommandType type;
    const void* payload = nullptr;  // a command::X of the type
};

template <class Command>
inline constexpr CommandType kCommandType = CommandType{};
#define VERNIER_COMMAND(name) \
    template <>               \
    inline constexpr CommandType kCommandType<command::name> = CommandType::name;
#include "runtime/command/commands.def"
#undef VERNIER_COMMAND

/// Not thread-safe while recording; may be executed many times, by one queue at a time.
class CommandBuffer {
  public:
    CommandBuffer() : arena_(16 * 1024) {}

    /// Spans inside `command` must already lie in this buffer's arena: see copy().
    template <class Command>
    void record(const Command& command) {
        auto* header = arena_.create(CommandHeader{nullptr, kCommandType<Command>, arena_.create(command)});
        (last_ ? last_->next : first_) = header;
        last_ = header;
    }

    template <class T>
    std::span<const T> copy(std::span<const T> source) {
        return arena_.copy(source);
    }

    Arena& arena() { return arena_; }
    const CommandHeader* first() const { return first_; }
    void reset() {
        arena_.reset();
        first_ = nullptr;
        last_ = nullptr;
    }

  private:
    Arena arena_;
    const CommandHeader* first_ = nullptr;
    CommandHeader* last_ = nullptr;
};

}  // namespace vernier
