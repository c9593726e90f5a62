#include "backend/device.hpp"
#include "core/error.hpp"

#include <charconv>

namespace weir::backend {

Choice parse_choice(std::string_view text) {
    const auto colon = text.find(':');
    const std::string_view name = text.substr(0, colon), more = colon == std::string_view::npos ? "" : text.substr(colon + 1);
    Choice choice;
    if (name == "threads") {
        if (colon == std::string_view::npos) return choice;
        choice.isa = more;
        for (const char* known : {"auto", "sse2", "avx2", "avx512"})
            if (more == known) return choice;
    }
    if (text == "reference") {
        choice.kind = Choice::Kind::reference;
        return choice;
    }
    if (name == "opencl") {
        choice.kind = Choice::Kind::opencl;
        if (colon == std::string_view::npos) return choice;
        const auto [end, error] = std::from_chars(more.data(), more.data() + more.size(), choice.device);
        if (error == std::errc() && end == more.data() + more.size() && choice.device >= 0) return choice;
    }
    throw BadInput("unknown backend \"" + std::string(text) +
                   "\"; known: threads, threads:sse2, threads:avx2, threads:avx512, opencl, opencl:N (weir list devices), reference");
}

}  // namespace weir::backend
