#include "particles/threads/isa.hpp"

#include "core/error.hpp"

#include <cstdlib>
#include <string>

namespace weir::particles {

const std::vector<const PassTable*>& available_passes() {
    static const std::vector<const PassTable*> list = [] {
        std::vector<const PassTable*> found;
        __builtin_cpu_init();
        if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
            __builtin_cpu_supports("avx512vl"))
            found.push_back(&passes_avx512);
        if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"))
            found.push_back(&passes_avx2);
        found.push_back(&passes_sse2);
        return found;
    }();
    return list;
}

const PassTable& passes_for(std::string_view name) {
    if (name.empty() || name == "auto") {
        const char* forced = std::getenv("WEIR_ISA");
        if (!forced || !*forced) return *available_passes().front();
        name = forced;
    }
    std::string known;
    for (const PassTable* table : available_passes()) {
        if (name == table->name) return *table;
        known += (known.empty() ? "" : ", ") + std::string(table->name);
    }
    throw BadInput("instruction set \"" + std::string(name) + "\" is not one that this processor runs: " + known);
}

}  // namespace weir::particles
