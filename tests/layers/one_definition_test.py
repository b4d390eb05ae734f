"""Plants what one_definition.py is to find, and what it is to let pass."""

import pathlib
import tempfile
import unittest

import one_definition


class OneDefinition(unittest.TestCase):
    def findings(self, **files):
        """Of files whose names have "__" for "/" and "_" for "."."""
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in files.items():
                path = root / "tests" / name.replace("__", "/").replace("_", ".")
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            return one_definition.findings(root)[2]

    def assertFound(self, findings, *words):
        self.assertEqual(len(findings), 1, findings)
        for word in words:
            self.assertIn(word, findings[0])

    def test_templates_with_other_bodies(self):
        text = """namespace vernier::HWY_NAMESPACE {
template <class Format>
HWY_INLINE uint32_t rowsOf(const Format& %s) { return %s; }
}"""
        self.assertFound(self.findings(a_cpp=text % ("in", "1"), b_cpp=text % ("format", "2")),
                         "tests/b.cpp:2: template vernier::HWY_NAMESPACE::rowsOf stands in tests/a.cpp:2, too")

    def test_templates_of_one_file(self):
        text = "namespace a { template <class T> int f(T) { return %d; } }"
        self.assertFound(self.findings(a_cpp=text % 1), "a.cpp:1: template f is in no header")
        self.assertFound(self.findings(a_cpp="namespace { } namespace a { inline int f(int) { return 1; } }"),
                         "inline function f")
        self.assertFound(self.findings(a_cpp='#include "x.h"\nextern "C" { struct Pair { int a, b; }; }'),
                         "a.cpp:2: class Pair")

    def test_inline_functions_of_headers(self):
        self.assertFound(self.findings(a_h="inline int twice(int x) { return 2 * x; }",
                                       sub__b_h="constexpr int twice(int value) { return value + value; }"),
                         "inline function ::twice stands in tests/a.h:1")
        self.assertEqual([], self.findings(a_h="inline int twice(int x) { return 2 * x; }",
                                           b_h="inline float twice(float x) { return 2 * x; }"))

    def test_classes(self):
        self.assertFound(self.findings(a_h="namespace n { class Pool final : public Base<int> { int a; }; }",
                                       b_h="namespace n { template <class T> struct Pool { T a; }; }"),
                         "class n::Pool stands in tests/a.h:1")

    def test_what_is_local_or_declared(self):
        self.assertEqual([], self.findings(
            a_h="namespace n { template <int k> void decode(const char*); struct Hidden; class Shown { void run(); }; }",
            a_cpp="""namespace n {
namespace {
template <class T> T first(T x) { return x; }  // "} }"
struct Local { const char* text = "}"; char c = '{'; };
}  // namespace
template <int k> void decode(const char* p) { first(p); }
struct Hidden { int a{1}; };
void Shown::run() { const auto f = [] { return R"({{)"; }; }
static inline int mine() { return 0; }
void ordinary() {}
Shown made{1, 2};
const int table[] = {1, 2};
}""",
            b_cpp="""namespace n { namespace { template <class T> T first(T x) { return -x; } struct Local {}; }
Thing::Thing(int a) : a_{a}, b_(a) { first(a); }
template <> struct std::hash<Thing> { int operator()(Thing) { return 1; } }; }"""))


if __name__ == "__main__":
    unittest.main()
