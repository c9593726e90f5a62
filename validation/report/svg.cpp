// Runs gnuplot on a program. The figure comes from its standard output, because a name after `set output` may be a command.
#include "validation/report/svg.hpp"

#include "core/error.hpp"
#include "core/programs.hpp"
#include "output/atomic_file.hpp"

#include <system_error>

namespace weir::validation {

void draw(const std::string& text, const std::filesystem::path& svg) {
    std::error_code failed;
    std::filesystem::create_directories(svg.parent_path(), failed);
    if (failed) throw OutputError("cannot make the folder " + svg.parent_path().string() + ": " + failed.message());
    const auto beside = [&](const char* ending) { return std::filesystem::absolute(svg).replace_extension(ending); };
    const auto program = beside(".gnuplot"), drawn = beside(".svg.part");
    output::write_file(program, text);
    const int code = run_program({"gnuplot", program.string()}, {.out = drawn});
    if (code != 0) {
        std::filesystem::remove(drawn, failed);
        throw OutputError(code == 127 ? "cannot draw " + svg.string() +
                                            ": gnuplot is not on the PATH (Debian: gnuplot-nox); its program is " + program.string()
                                      : "gnuplot could not draw " + svg.string() + "; its program is " + program.string());
    }
    std::filesystem::rename(drawn, svg, failed);
    if (failed) throw OutputError("cannot write " + svg.string() + ": " + failed.message());
    std::filesystem::remove(program, failed);
}

}  // namespace weir::validation
