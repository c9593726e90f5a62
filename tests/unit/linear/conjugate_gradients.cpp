// Conjugate gradients on small dense matrices: finite termination, the stop test, and what happens where there is no solution to reach.
#include "linear/conjugate_gradients.hpp"

#include "core/error.hpp"
#include "support/test.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

namespace conjugate_gradients_tests {

using namespace weir;

namespace {

using Vector = std::vector<real>;
using Map = std::function<Vector(const Vector&)>;

real dot(const Vector& a, const Vector& b) { return std::inner_product(a.begin(), a.end(), b.begin(), real{0}); }

/// A = H diag(λ) H with the reflection H = 1 − 2 v vᵀ/(v·v), v = (1, 2, 3, ...): all entries of A are nonzero.
Map matrix(const Vector& eigenvalues) {
    return [=](const Vector& x) {
        Vector v(x.size()), y = x;
        std::iota(v.begin(), v.end(), 1.0);
        const auto reflect = [&] {
            const real c = 2 * dot(v, y) / dot(v, v);
            for (std::size_t i = 0; i < y.size(); ++i) y[i] -= c * v[i];
        };
        reflect();
        for (std::size_t i = 0; i < y.size(); ++i) y[i] *= eigenvalues[i];
        reflect();
        return y;
    };
}

const Map identity = [](const Vector& x) { return x; };

/// A system in std::vectors, from x = 0.
template <linear::Norm N>
struct Dense {
    static constexpr linear::Norm norm = N;
    Map A, M;
    Vector r, x = Vector(r.size()), z = x, p = x, Ap = x;
    real b_norm = std::sqrt(dot(r, r));

    real precondition() {
        z = M(r);
        return dot(r, z);
    }
    void update_direction(real beta) {
        for (std::size_t i = 0; i < p.size(); ++i) p[i] = z[i] + (beta == 0 ? 0 : beta * p[i]);
    }
    real multiply() {
        Ap = A(p);
        return dot(p, Ap);
    }
    real advance(real alpha) {
        for (std::size_t i = 0; i < x.size(); ++i) x[i] += alpha * p[i], r[i] -= alpha * Ap[i];
        return std::sqrt(dot(r, r)) / b_norm;
    }
};

/// The same with the β of a preconditioner that changes.
struct Flexible : Dense<linear::Norm::residual> {
    real largest_overlap = 0;  // |p·A p'|/(‖p‖ ‖A p'‖) of successive directions

    real flexible_beta(const linear::Step& last) const { return -dot(z, Ap) / last.pAp; }
    void update_direction(real beta) {
        Dense::update_direction(beta);
        if (beta != 0) largest_overlap = std::max(largest_overlap, std::abs(dot(p, Ap)) / std::sqrt(dot(p, p) * dot(Ap, Ap)));
    }
};

struct Solved {
    linear::Outcome outcome;
    int iterations;
    Vector x, history;
};

template <class System>
Solved solve(System system, real tolerance, int limit) {
    Solved solved{};
    linear::StopTest stop(tolerance, limit, solved.iterations, &solved.history);
    solved.outcome = linear::conjugate_gradients(system, stop);
    solved.x = system.x;
    return solved;
}

template <linear::Norm N = linear::Norm::residual>
Dense<N> dense(const Map& A, const Vector& b, const Map& M = identity) {
    return {.A = A, .M = M, .r = b};
}

Flexible flexible(const Map& A, const Vector& b, const Map& M) { return {dense(A, b, M)}; }

real error(const Vector& x, const Vector& exact) {
    real most = 0;
    for (std::size_t i = 0; i < x.size(); ++i) most = std::max(most, std::abs(x[i] - exact[i]));
    return most;
}

const Vector answer{1, -2, 0.5, 3, -1, 0.25};

std::string message(const std::function<void()>& f) {
    try {
        f();
    } catch (const NumericalFailure& failure) {
        return failure.quantity + ": " + failure.what();
    }
    return "nothing was thrown";
}

}  // namespace

TEST("a matrix with k distinct eigenvalues takes k iterations, in either norm") {
    for (const Vector& eigenvalues : {Vector{3, 3, 3, 3, 3, 3}, Vector{1, 1, 5, 5, 5, 1}, Vector{1, 1, 4, 4, 9, 9}}) {
        const Map A = matrix(eigenvalues);
        Vector distinct = eigenvalues;
        std::sort(distinct.begin(), distinct.end());
        const auto k = std::unique(distinct.begin(), distinct.end()) - distinct.begin();
        // round-off of 6 numbers, times the condition number 9
        const Solved by_residual = solve(dense(A, A(answer)), 1e-12, 20);
        EXPECT_EQ(by_residual.iterations, k);
        EXPECT_LT(error(by_residual.x, answer), 1e-13);
        const Solved natural = solve(dense<linear::Norm::natural>(A, A(answer)), 1e-12, 20);
        EXPECT_EQ(natural.iterations, k);
        EXPECT_EQ(error(natural.x, by_residual.x), 0) << "with M = 1 both norms are one";
        EXPECT_LT(error(natural.history, by_residual.history), 1e-15);
    }
}

TEST("the exact inverse as preconditioner takes one iteration, and half of it too: the scale of M does not matter") {
    const Map A = matrix({1, 2, 3, 50, 500, 5000}), inverse = matrix({1, 0.5, 1.0 / 3, 0.02, 0.002, 0.0002});
    const Map half = [&](const Vector& r) {
        Vector z = inverse(r);
        for (real& value : z) value /= 2;
        return z;
    };
    for (const Map& M : {inverse, half}) {
        const Solved solved = solve(dense(A, A(answer), M), 1e-10, 20);
        EXPECT_EQ(solved.iterations, 1);
        EXPECT_LT(error(solved.x, answer), 1e-11);  // round-off times the condition number 5000
    }
}

TEST("with a constant preconditioner the flexible form takes the same steps") {
    const Map A = matrix({1, 2, 3, 5, 7, 11}), M = matrix({1, 1, 0.5, 0.5, 0.1, 0.1});
    const Solved fixed = solve(dense(A, A(answer), M), 1e-11, 20), other = solve(flexible(A, A(answer), M), 1e-11, 20);
    ASSERT_EQ(other.iterations, fixed.iterations);
    for (std::size_t i = 0; i < fixed.history.size(); ++i) EXPECT_NEAR(other.history[i], fixed.history[i], 1e-10 * fixed.history[0]);
    EXPECT_LT(error(other.x, answer), 1e-10);
}

TEST("where M changes from iteration to iteration, the flexible form keeps each direction conjugate to the last one") {
    const Map A = matrix({1, 2, 3, 50, 60, 70});
    const Map changing = [count = 0](const Vector& r) mutable {
        Vector z = r;
        const bool odd = count++ % 2 == 1;
        for (std::size_t i = 0; i < z.size(); ++i) z[i] *= odd == (i % 2 == 1) ? 1 : 3;
        return z;
    };
    int iterations = 0;
    linear::StopTest stop(1e-8, 1000, iterations);
    Flexible system = flexible(A, A(answer), changing);
    const linear::Outcome outcome = linear::conjugate_gradients(system, stop);
    EXPECT_LE(outcome.relative_residual, 1e-8);
    EXPECT_LT(system.largest_overlap, 1e-13);  // round-off of 6 numbers of different signs
    EXPECT_LT(error(system.x, answer), 1e-6);  // the tolerance times the condition number 70, ‖b‖ of 200
}

TEST("the stop test ends the iterations at the tolerance, at the limit, and at a residual that is not finite") {
    const Map A = matrix({1, 2, 3, 5, 7, 11});
    const Solved all = solve(dense(A, A(answer)), 1e-12, 20);
    ASSERT_EQ(all.iterations, 6);
    ASSERT_EQ(all.history.size(), 6u);
    const Solved loose = solve(dense(A, A(answer)), all.history[2], 20);
    EXPECT_EQ(loose.iterations, 3) << "a residual equal to the tolerance is enough";
    EXPECT_EQ(loose.outcome.relative_residual, all.history[2]);
    const Solved limited = solve(dense(A, A(answer)), 1e-12, 2);
    EXPECT_EQ(limited.iterations, 2);
    EXPECT_EQ(limited.outcome.relative_residual, all.history[1]);
    const Solved infinite = solve(dense([](const Vector& x) { return Vector(x.size(), infinity); }, answer), 1e-12, 20);
    EXPECT_LE(infinite.iterations, 1);
    EXPECT_FALSE(infinite.outcome.relative_residual <= 1e-12);
    int earlier = 3;
    const linear::StopTest stop(1e-3, 5, earlier);
    EXPECT_TRUE(stop.wants_more(2e-3));
    EXPECT_FALSE(stop.would_end(2e-3));
    EXPECT_TRUE(stop.would_end(1e-3));
    earlier = 4;
    EXPECT_TRUE(stop.would_end(1)) << "the fifth is the last: iterations of an earlier attempt count";
}

TEST("b = 0 takes no iteration and is no failure; NaN is one") {
    for (const real value : {0.0, std::nan("")}) {
        const Solved solved = solve(dense<linear::Norm::natural>(matrix({1, 2}), {value, value}), 1e-12, 20);
        EXPECT_EQ(solved.iterations, 0);
        EXPECT_FALSE(solved.outcome.broke_down);
        EXPECT_EQ(solved.outcome.relative_residual <= 1e-12, value == 0);
    }
}

TEST("an indefinite matrix or preconditioner ends the iterations, and the failure says so") {
    const Map indefinite = matrix({1, -2}), minus = [](const Vector&r) { return Vector{-r[0], -r[1]}; };
    const Vector b = indefinite({0, 1});
    for (const auto& solved : {solve(dense(indefinite, b), 1e-12, 20), solve(dense(matrix({1, 2}), b, minus), 1e-12, 20),
                               solve(dense<linear::Norm::natural>(matrix({1, 2}), b, minus), 1e-12, 20)}) {
        EXPECT_TRUE(solved.outcome.broke_down);
        int iterations = solved.iterations;
        const linear::StopTest stop(1e-12, 20, iterations);
        EXPECT_NE(
            message([&] { linear::require_converged("velocity", "viscous solve", solved.outcome, stop); }).find("not positive definite"),
            std::string::npos);
    }
}

TEST("one message of a missed tolerance: quantity, solve, residual, iterations and tolerance; none where it is reached") {
    int iterations = 7;
    const linear::StopTest stop(1e-6, 7, iterations);
    EXPECT_EQ(message([&] {
                  linear::require_converged("velocity", "viscous solve", {2.5e-6, false}, stop);
              }),
              "velocity: viscous solve: relative residual 2.5e-06 after 7 iterations, tolerance 1e-06");
    EXPECT_NE(message([&] { linear::require_converged("velocity", "viscous solve", {std::nan(""), false}, stop); }), "nothing was thrown");
    EXPECT_EQ(message([&] { linear::require_converged("velocity", "viscous solve", {1e-6, false}, stop); }), "nothing was thrown");
}

}  // namespace conjugate_gradients_tests
