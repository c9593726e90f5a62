#include "particles/isa.hpp"

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

scene::Key backend_key() {
    return {
        .name = "backend",
        .type = scene::Type::text,
        .doc =
            "threads: the processor, with the best of its instruction sets, or one by name: threads:sse2, threads:avx2, threads:avx512. "
            "opencl: the first OpenCL device, or one by number: opencl:1 (weir list devices). reference: plain double precision over all "
            "pairs on one thread, what the others are compared with; for at most a few thousand particles.",
        .fallback = std::string("threads")};
}

backend::Choice backend_of(const scene::Scene& scene) {
    try {
        return backend::parse_choice(scene.text("scheme.backend"));
    } catch (const BadInput& error) {
        scene.refuse("scheme.backend", error.what());
    }
}

}  // namespace weir::particles
