// What libraries would bring into the driver for nobody's use. A linker takes whole members of archives: where the
// driver has the one function of a member that others name, the rest of it, and all that it names in turn, stays
// outside.
#include <cstdio>
#include <cstdlib>
#include <exception>

#include <spirv-tools/libspirv.h>

/// Of SPIRV-Tools' assembler, which the disassembler shares. As there.
void spvTextDestroy(spv_text text) {
    if (text == nullptr) return;
    delete[] text->str;
    delete text;
}

#ifdef __GLIBCXX__
/// Of the C++ library, where it comes with what turns symbols into names. The driver throws nothing out of its
/// functions.
void __gnu_cxx::__verbose_terminate_handler() {  // NOLINT(bugprone-reserved-identifier)
    std::fputs("vernier: terminated by an exception\n", stderr);
    std::abort();
}
#endif
