#include "poisson/geometric/phase_matrix.hpp"

#include <algorithm>

namespace weir::poisson {

namespace {

constexpr auto fluid = static_cast<std::uint8_t>(Cell::fluid), air = static_cast<std::uint8_t>(Cell::air);

constexpr real floor_ratio = 4;  // strong faces have more than this many times the weight of the heavier phase

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The faces of cells, by the lower and the upper side of each axis.
template <int D>
class CellFaces {
public:
    explicit CellFaces(const Natural<D>& problem) : problem_(problem), n_(problem.extent()) {}
    /// f(axis, weight, neighbour) for each open face of a fluid cell; neighbour −1: p = 0.
    template <class F>
    void of(int cell, F&& f) const {
        const int row = cell / n_[0], i = cell - row * n_[0], q = D == 2 ? row : row / n_[1], j = D == 2 ? 0 : row - q * n_[1];
        for (int a = 0; a < D; ++a)
            for (int side = 0; side < 2; ++side) {
                const int beside = neighbour(cell, i, q, j, a, side);
                if (beside < 0) {
                    const real w = own_face(a, side, q, j)[i];
                    if (w > 0 && beyond(i, q, j, a, side) == air) f(a, w, -1);
                    continue;
                }
                const real w = side == 0 ? problem_.faces(a, q, j)[i] : lower_face(beside, a);
                if (!(w > 0)) continue;
                const std::uint8_t other = kind(beside);
                if (other == fluid) f(a, w, beside);
                if (other == air) f(a, w, -1);
            }
    }

private:
    int neighbour(int cell, int i, int q, int j, int a, int side) const {
        if (a > 0) {
            const int row = problem_.neighbour(q, j, a, side);
            return row < 0 ? -1 : row * n_[0] + i;
        }
        if (side == 0 ? i > 0 : i + 1 < n_[0]) return cell + (side == 0 ? -1 : 1);
        return problem_.periodic()[0] && n_[0] > 1 ? cell + (side == 0 ? n_[0] - 1 : 1 - n_[0]) : -1;
    }
    const real* own_face(int a, int side, int q, int j) const {
        const bool up = side == 1;
        return problem_.faces(a, q + (a == D - 1 && up), j + (a > 0 && a != D - 1 && up)) + (a == 0 && up ? 1 : 0);
    }
    real lower_face(int cell, int a) const {
        const int row = cell / n_[0], q = D == 2 ? row : row / n_[1];
        return problem_.faces(a, q, D == 2 ? 0 : row - q * n_[1])[cell - row * n_[0]];
    }
    std::uint8_t beyond(int i, int q, int j, int a, int side) const {
        return a == 0 ? problem_.cells(problem_.row(q, j))[side == 0 ? -1 : n_[0]] : problem_.cells(-1)[i];
    }
    std::uint8_t kind(int cell) const {
        const int row = cell / n_[0];
        return problem_.cells(row)[cell - row * n_[0]];
    }
    const Natural<D>& problem_;
    Index<D> n_;
};

/// f(row, below, axis, weights) for each row of cells and its lower faces along each axis, the last axis first; `below`: the row of the
/// cells on the other side of these faces (along x the same row), which are not outside.
template <int D, class F>
void for_each_row_of_faces(const Natural<D>& problem, F&& f) {
    for (int q = 0; q < problem.planes(); ++q)
        for (int j = 0; j < problem.rows_in_plane(); ++j)
            for (int a = D - 1; a >= 0; --a) {
                const int row = problem.row(q, j), below = a == 0 ? row : problem.neighbour(q, j, a, 0);
                if (below >= 0 && !problem.is_dry(row)) f(row, below, a, problem.faces(a, q, j));
            }
}

/// The cells of the faces of a row: cell i and the one below.
int cell_below(int row, int below, int i, int n, int axis) { return axis > 0 ? below * n + i : row * n + (i > 0 ? i - 1 : n - 1); }

/// The members of each aggregate, in rising order.
struct Members {
    std::vector<int> start, list;
    explicit Members(const Aggregation& groups) : start(at(groups.count) + 1, 0) {
        for (const int k : groups.of)
            if (k >= 0) ++start[at(k) + 1];
        for (std::size_t k = 0; k < at(groups.count); ++k) start[k + 1] += start[k];
        list.resize(at(start.back()));
        std::vector<int> next(start.begin(), start.end() - 1);
        for (std::size_t i = 0; i < groups.of.size(); ++i)
            if (const int k = groups.of[i]; k >= 0) list[at(next[at(k)]++)] = static_cast<int>(i);
    }
};

/// The matrix of aggregates. faces(i, f) calls f(weight, j) for the faces of unknown i, j = −1: to p = 0, with weights as the coarse matrix
/// adds them.
template <class Faces>
Matrix assemble(const Aggregation& groups, const Faces& faces) {
    const Members members(groups);
    Matrix A;
    const std::size_t n = at(groups.count);
    A.start.reserve(n + 1), A.diagonal.reserve(n), A.column.reserve(6 * n), A.weight.reserve(6 * n);
    std::vector<int> seen(n, -1);  // entry of a column in the present row
    for (int k = 0; k < groups.count; ++k) {
        const int begin = A.start.back();
        real zero = 0;
        for (int m = members.start[at(k)]; m < members.start[at(k) + 1]; ++m)
            faces(members.list[at(m)], [&](real w, int j) {
                if (j < 0) return void(zero += w);
                const int other = groups.of[at(j)];
                if (other == k) return;
                int& entry = seen[at(other)];
                if (entry < begin) {
                    entry = static_cast<int>(A.column.size());
                    A.column.push_back(other), A.weight.push_back(0);
                }
                A.weight[at(entry)] += w;
            });
        sort_last_row(A);
        real diagonal = 0;
        for (std::size_t e = at(begin); e < A.column.size(); ++e) diagonal += A.weight[e] = static_cast<float>(A.weight[e]);
        A.diagonal.push_back(diagonal + zero);
        A.start.push_back(static_cast<int>(A.column.size()));
    }
    return A;
}

/// The factor of a weight between unknowns of different aggregates: a half, or 1 between boxes along an axis that is not coarsened.
template <int D>
real weight_factor(const PhaseUnknowns<D>& unknowns, const std::array<bool, D>& halved, int i, int j) {
    const int apart = std::abs(unknowns.box[at(i)] - unknowns.box[at(j)]);
    int stride = 1;
    for (int a = 0; a < D; ++a) {
        const bool along = apart == stride || (unknowns.boxes[a] > 2 && apart == (unknowns.boxes[a] - 1) * stride);
        if (along && unknowns.boxes[a] > 1 && !halved[at(a)]) return 1;
        stride *= unknowns.boxes[a];
    }
    return 0.5;
}

/// The mean weight along each axis of faces between cells of the heavier phase, 0: none.
template <int D>
Vec<D> mean_heavy_weight(const Natural<D>& problem, const std::uint8_t* light) {
    Vec<D> sum{}, count{}, mean{};
    const int n = problem.extent()[0];
    for_each_row_of_faces(problem, [&](int row, int below, int a, const real* w) {
        const std::uint8_t *own = light + row * n, *other = a == 0 ? own - 1 : light + below * n;
        real weights = 0, faces = 0;
#pragma omp simd reduction(+ : weights, faces)
        for (int i = a == 0 ? 1 : 0; i < n; ++i) {
            const bool heavy = own[i] == 0 && other[i] == 0 && w[i] > 0;
            weights += heavy ? w[i] : 0, faces += heavy ? 1 : 0;
        }
        sum[a] += weights, count[a] += faces;
    });
    for (int a = 0; a < D; ++a) mean[a] = count[a] > 0 ? sum[a] / count[a] : 0;
    return mean;
}

/// The largest weight of each cell.
template <int D>
std::vector<float> largest_weights(const Natural<D>& problem) {
    const int n = problem.extent()[0];
    std::vector<float> most(static_cast<std::size_t>(n) * static_cast<std::size_t>(problem.planes() * problem.rows_in_plane()), 0);
    const auto raise = [](float& m, real w) { m = std::max(m, static_cast<float>(w)); };
    for_each_row_of_faces(problem, [&](int row, int below, int a, const real* w) {
        float *own = most.data() + row * n, *other = a == 0 ? own - 1 : most.data() + below * n;
        const int first = a == 0 ? 1 : 0;
        for (int i = first; i < n; ++i) raise(own[i], w[i]);
        for (int i = first; i < n; ++i) raise(other[i], w[i]);
        if (a == 0 && problem.periodic()[0]) raise(own[0], w[0]), raise(own[n - 1], w[0]);
    });
    return most;
}

}  // namespace

template <int D>
PhaseCells<D> find_phase_cells(const Natural<D>& problem, const std::uint8_t* light) {
    PhaseCells<D> found;
    found.unknowns = unknown_cells(problem);
    found.floor = floor_ratio * mean_heavy_weight(problem, light);
    const auto& box = found.unknowns.box;
    ClusterFinder finder(box.size());
    const std::vector<float> most = largest_weights(problem);
    const int n = problem.extent()[0];
    for_each_row_of_faces(problem, [&](int row, int below, int a, const real* w) {
        const auto floor = found.floor[a];
        for (int i = a > 0 || problem.periodic()[0] ? 0 : 1; i < n; ++i) {
            if (!(w[i] > floor)) continue;
            const int one = row * n + i, other = cell_below(row, below, i, n, a);
            if (box[at(one)] < 0 || box[at(other)] < 0) continue;
            if (is_strong(w[i], most[at(one)], most[at(other)], floor)) finder.join(one, other);
        }
    });
    found.clusters = finder.find(found.unknowns);
    const float quarter = most.empty() ? 0 : 0.25F * *std::max_element(most.begin(), most.end());
    std::vector<char> light_cluster(found.clusters.extent.size(), 0);
    for (std::size_t i = 0; i < most.size(); ++i)
        if (const int c = found.clusters.of[i]; c >= 0 && most[i] >= quarter) light_cluster[at(c)] = 1;
    found.light_clusters = static_cast<int>(std::count(light_cluster.begin(), light_cluster.end(), 1));
    return found;
}

template <int D>
Clusters clusters_of(const Matrix& A, const PhaseUnknowns<D>& unknowns, real floor) {
    std::vector<real> most(A.diagonal.size(), 0);
    for (std::size_t i = 0; i < most.size(); ++i)
        for (int k = A.start[i]; k < A.start[i + 1]; ++k) most[i] = std::max(most[i], A.weight[at(k)]);
    ClusterFinder finder(A.diagonal.size());
    for (int i = 0; i < A.size(); ++i) {
        if (!(most[at(i)] > floor)) continue;
        for (int k = A.start[at(i)]; k < A.start[at(i) + 1]; ++k)
            if (const int j = A.column[at(k)]; j > i && is_strong(A.weight[at(k)], most[at(i)], most[at(j)], floor)) finder.join(i, j);
    }
    return finder.find(unknowns);
}

template <int D>
Matrix matrix_of_cells(const Natural<D>& problem, const Aggregation& groups, const std::array<bool, D>& halved) {
    const CellFaces<D> faces(problem);
    const real scale = zero_scale(1);
    Vec<D> factor;
    for (int a = 0; a < D; ++a) factor[a] = halved[at(a)] ? 0.5 : 1;
    return assemble(groups, [&](int cell, const auto& f) {
        faces.of(cell, [&](int axis, real w, int other) { f(other < 0 ? scale * w : factor[axis] * w, other); });
    });
}

template <int D>
Matrix matrix_of(const Matrix& fine, const PhaseUnknowns<D>& unknowns, const Aggregation& groups, const std::array<bool, D>& halved) {
    const real scale = zero_scale(unknowns.width);
    bool all = true;
    for (int a = 0; a < D; ++a) all = all && (halved[at(a)] || unknowns.boxes[a] == 1);
    return assemble(groups, [&](int i, const auto& f) {
        real weights = 0;  // in the order of the diagonal: the difference is exactly zero without a face to p = 0
        for (int k = fine.start[at(i)]; k < fine.start[at(i) + 1]; ++k) {
            const int j = fine.column[at(k)];
            weights += fine.weight[at(k)];
            f((all ? 0.5 : weight_factor<D>(unknowns, halved, i, j)) * fine.weight[at(k)], j);
        }
        f(scale * (fine.diagonal[at(i)] - weights), -1);
    });
}

template PhaseCells<2> find_phase_cells<2>(const Natural<2>&, const std::uint8_t*);
template PhaseCells<3> find_phase_cells<3>(const Natural<3>&, const std::uint8_t*);
template Clusters clusters_of<2>(const Matrix&, const PhaseUnknowns<2>&, real);
template Clusters clusters_of<3>(const Matrix&, const PhaseUnknowns<3>&, real);
template Matrix matrix_of_cells<2>(const Natural<2>&, const Aggregation&, const std::array<bool, 2>&);
template Matrix matrix_of_cells<3>(const Natural<3>&, const Aggregation&, const std::array<bool, 3>&);
template Matrix matrix_of<2>(const Matrix&, const PhaseUnknowns<2>&, const Aggregation&, const std::array<bool, 2>&);
template Matrix matrix_of<3>(const Matrix&, const PhaseUnknowns<3>&, const Aggregation&, const std::array<bool, 3>&);

}  // namespace weir::poisson
