// Bodies of main() of fragment shaders that between them use the whole language; front_meaning_test.cpp runs each in
// four ways and compares.
#pragma once

#include <string>
#include <vector>

namespace vernier::test {

struct Snippet {
    std::string name;
    std::string functions;  // before main()
    std::string body;
};

/// What comes before every snippet: inputs a, b (vec4), i (ivec4), j (uvec4), buffers u, s, pc, output o and p.
extern const char* const kSnippetPrologue;

std::vector<Snippet> snippets();

}  // namespace vernier::test
