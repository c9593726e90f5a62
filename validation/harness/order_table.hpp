// Orders of accuracy from a sweep of grids, Richardson's value at h = 0, and the grid convergence index (GCI).
// Roache 1998; Celik, Ghia, Roache & Freitas 2008 (J. Fluids Eng. 130, 078001); NPARC's asymptotic check.
#pragma once
#include "core/types.hpp"
#include "validation/harness/metric.hpp"

#include <string>
#include <vector>

namespace weir::validation {

/// What two or three grids say about h = 0. NaN where they cannot say.
struct Extrapolation {
    real order = std::nan("");       // p
    real limit = std::nan("");       // f(h = 0)
    real change = std::nan("");      // |(f1 - f2) / f1|, finest two
    real gci_fine = std::nan("");    // of grids 1-2; relative for values, absolute for errors
    real gci_coarse = std::nan("");  // of grids 2-3, relative
    real asymptotic = std::nan("");  // GCI23 / (r^p GCI12): about 1 where the order may be quoted
    bool monotone = false;           // f1 - f2 and f2 - f3 have one sign
};

class OrderTable {
public:
    struct Row {
        real h = 0;
        real value = 0;
        real order = std::nan("");  // log(e_coarser / e) / log(h_coarser / h); NaN in the coarsest row
    };

    /// Values whose limit is 0 (errors) or unknown.
    explicit OrderTable(Quantity quantity) : quantity_(quantity) {}

    /// In any sequence; rows are kept from coarse to fine.
    void add(real h, real value);
    const std::vector<Row>& rows() const { return rows_; }
    Quantity quantity() const { return quantity_; }

    /// The observed order at the finest grids: of errors from the finest pair, of values from the finest three (Celik 2008, eq. 3).
    real order() const;
    /// From the finest three grids with their own order (factor of safety 1.25). With two grids only, or none of the three
    /// conclusive, `formal_order` is taken on trust and the factor is 3.
    Extrapolation extrapolate(real formal_order = std::nan("")) const;

private:
    Quantity quantity_;
    std::vector<Row> rows_;
};

/// Apparent order p of three grids with values f1 (finest), f2, f3 and ratios r21 = h2/h1, r32 = h3/h2: the fixed point of
/// p = |ln|e32/e21| + q(p)| / ln r21,  q(p) = ln((r21^p - s) / (r32^p - s)),  s = sign(e32/e21)   (Celik 2008, eq. 3).
real apparent_order(real f1, real f2, real f3, real r21, real r32);

}  // namespace weir::validation
