// See order_table.hpp for the papers.
#include "validation/harness/order_table.hpp"

#include <algorithm>

namespace weir::validation {

void OrderTable::add(real h, real value) {
    const auto finer = std::find_if(rows_.begin(), rows_.end(), [&](const Row& r) { return r.h < h; });
    rows_.insert(finer, {.h = h, .value = value});
    if (quantity_ == Quantity::value) return;
    for (std::size_t i = 1; i < rows_.size(); ++i)
        rows_[i].order = std::log(rows_[i - 1].value / rows_[i].value) / std::log(rows_[i - 1].h / rows_[i].h);
}

real OrderTable::order() const {
    if (quantity_ == Quantity::error) return rows_.empty() ? std::nan("") : rows_.back().order;
    return extrapolate().order;
}

real apparent_order(real f1, real f2, real f3, real r21, real r32) {
    const real e21 = f2 - f1, e32 = f3 - f2;
    if (e21 == 0 || e32 == 0) return std::nan("");
    const real s = e32 / e21 > 0 ? 1 : -1;
    real p = std::abs(std::log(std::abs(e32 / e21))) / std::log(r21);
    for (int i = 0; i < 200; ++i) {  // a contraction for the ratios in use: 50 rounds reach round-off
        const real q = std::log((std::pow(r21, p) - s) / (std::pow(r32, p) - s));
        p = std::abs(std::log(std::abs(e32 / e21)) + q) / std::log(r21);
    }
    return p;
}

Extrapolation OrderTable::extrapolate(real formal_order) const {
    Extrapolation x;
    const std::size_t n = rows_.size();
    if (n < 2) return x;
    const Row &one = rows_[n - 1], &two = rows_[n - 2];
    const real r21 = two.h / one.h;
    real safety = 3.0;  // Roache: two grids, order assumed
    x.order = formal_order;
    if (n >= 3) {
        const Row& three = rows_[n - 3];
        const real p = apparent_order(one.value, two.value, three.value, r21, three.h / two.h);
        if (std::isfinite(p)) x.order = p, safety = 1.25;  // Roache: three grids, order observed
        x.monotone = (one.value - two.value) * (two.value - three.value) > 0;
    }
    const auto gci = [&](real fine, real coarse, real r) {
        const real scale = quantity_ == Quantity::error ? 1 : std::abs(fine);  // relative to a value whose limit is 0 means nothing
        return safety * std::abs(fine - coarse) / scale / (std::pow(r, x.order) - 1);
    };
    x.change = std::abs((one.value - two.value) / one.value);
    x.limit = one.value + (one.value - two.value) / (std::pow(r21, x.order) - 1);
    x.gci_fine = gci(one.value, two.value, r21);
    if (n >= 3) {
        x.gci_coarse = gci(two.value, rows_[n - 3].value, rows_[n - 3].h / two.h);
        x.asymptotic = x.gci_coarse / (std::pow(r21, x.order) * x.gci_fine);
    }
    return x;
}

}  // namespace weir::validation
