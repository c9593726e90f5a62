#include "sim/requested_times.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weir::sim {

namespace {

constexpr real exact_integers = 9007199254740992.0;  // 2^53: integers up to here are doubles

}  // namespace

real requested_time(real every, std::int64_t k) {
    const auto n = static_cast<real>(k);
    for (real power = 1; power <= 1e15; power *= 10) {  // powers of ten up to 1e22 are doubles
        const real m = std::round(every * power);
        if (!(m * n < exact_integers)) break;
        if (m >= 1 && m / power == every) return m * n / power;  // one rounding, of the quotient
    }
    return n * every;
}

std::int64_t first_after(real every, real t) {
    const real now = t + same_time(t);
    auto k = static_cast<std::int64_t>(std::min(std::floor(now / every), exact_integers));
    if (!(every > 4 * same_time(t))) return k + 1;        // closer than the time tolerance: each step reaches several
    while (k > 0 && requested_time(every, k) > now) --k;  // the quotient may have been rounded up
    while (t >= requested_time(every, k) - same_time(requested_time(every, k))) ++k;
    return k;
}

real same_time(real t) { return 16 * std::numeric_limits<real>::epsilon() * std::max(std::abs(t), std::numeric_limits<real>::min()); }

}  // namespace weir::sim
