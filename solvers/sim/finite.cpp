#include "sim/finite.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

namespace weir::sim {

namespace {

/// Infinity and NaN are the doubles whose exponent bits are all set. The comparison of integers lets the loop be vectorized.
bool all_finite(std::span<const real> values) {
    constexpr std::uint64_t exponent = 0x7ff0000000000000ull;
    std::uint64_t bad = 0;
    for (const real value : values) bad |= static_cast<std::uint64_t>((std::bit_cast<std::uint64_t>(value) & exponent) == exponent);
    return bad == 0;
}

/// The same in blocks over all threads; a block is large enough to amortize the cost of a thread.
bool all_finite_threaded(std::span<const real> values) {
    constexpr std::size_t block = 1u << 16;
    const auto blocks = static_cast<int>((values.size() + block - 1) / block);
    return 0 == exact_sum(blocks, [&](int b) {
               const std::size_t begin = static_cast<std::size_t>(b) * block;
               return all_finite(values.subspan(begin, std::min(block, values.size() - begin))) ? 0.0 : 1.0;
           });
}

}  // namespace

void check_finite(const FieldSet& fields, const StepReport& report) {
    for (const auto& field : fields.fields)
        for (const auto& component : field.data)
            if (!all_finite_threaded(component)) throw NumericalFailure(field.name, field.name + " is no longer finite");
    if (std::isinf(report.cfl)) throw NumericalFailure("velocity", "velocity is no longer finite");
    if (std::isinf(report.max_divergence)) throw NumericalFailure("divergence", "divergence is no longer finite");
}

}  // namespace weir::sim
