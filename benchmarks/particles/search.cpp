// Neighbour search by its three methods and by the fast path's list, on points as dense as a liquid's: milliseconds against their number.
#include "core/parallel.hpp"
#include "particles/reference/neighbours.hpp"
#include "particles/threads/pairs.hpp"

#include <fmt/core.h>

#include <chrono>
#include <functional>
#include <random>

using namespace weir;
using namespace weir::particles;

namespace {

/// The fastest of a few runs [ms].
double fastest(const std::function<void()>& f, int runs) {
    double best = infinity;
    for (int r = 0; r < runs; ++r) {
        const auto start = std::chrono::steady_clock::now();
        f();
        best = std::min(best, 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return best;
}

}  // namespace

int main() {
    fmt::print("particles,method,threads,ms\n");
    for (const int n : {800, 4000, 32000, 128000, 1000000}) {
        std::mt19937 random(3);
        const double side = std::cbrt(n);  // spacing 1
        std::uniform_real_distribution<real> anywhere(0, side);
        std::array<std::vector<real>, 3> p;
        for (auto& axis : p)
            for (int i = 0; i < n; ++i) axis.push_back(anywhere(random));
        const Coordinates x{p[0].data(), p[1].data(), p[2].data()};
        for (const auto& method : neighbour_methods()) {
            if (method == "brute_force" && n > 32000) continue;  // n^2: minutes
            const auto search = make_neighbour_search(method);
            fmt::print("{},{},{},{:.3f}\n", n, method, threads(), fastest([&] { search->find(x, n, 2); }, n > 10000 ? 3 : 10));
        }
        Pairs pairs(*available_passes().front(), Frame{});
        fmt::print("{},{} list,{},{:.3f}\n", n, pairs.table().name, threads(), fastest([&] { pairs.find(x, n, 2); }, n > 500000 ? 3 : 10));
    }
}
