// Transfers between a level and the next: linear prolongation along all axes, and its transpose. Along its own axis a face has fine faces
// at its place (weight 1) and beside it (1/2); along another axis, at 1/4 and 3/4 of a coarse cell (weights 3/4 and 1/4).
#include "mac/viscous/level.hpp"

namespace weir::mac::viscous {

namespace {

/// Entries first .. first + count − 1 of the other level, with their weights.
struct Weights {
    int first = 0, count = 1;
    std::array<float, 4> w{1, 0, 0, 0};
};

/// Fine entries that a coarse one collects: the weights of the prolongation, halved.
Weights collected(int coarse, bool on_node, bool halved) {
    if (!halved) return {coarse, 1, {1, 0, 0, 0}};
    if (on_node) return {2 * coarse - 1, 3, {0.25f, 0.5f, 0.25f, 0}};
    return {2 * coarse - 1, 4, {0.125f, 0.375f, 0.375f, 0.125f}};
}

/// Coarse entries that a fine one interpolates.
Weights interpolated(int fine, bool on_node, bool halved) {
    if (!halved) return {fine, 1, {1, 0, 0, 0}};
    const int half = fine / 2;
    if (on_node) return fine % 2 == 0 ? Weights{half, 1, {1, 0, 0, 0}} : Weights{half, 2, {0.5f, 0.5f, 0, 0}};
    return fine % 2 == 0 ? Weights{half - 1, 2, {0.25f, 0.75f, 0, 0}} : Weights{half, 2, {0.75f, 0.25f, 0, 0}};
}

/// row[i] = Σ w q over the weights of the axes across rows, for i in [begin, end).
template <int D>
void combine(const Field<D>& q, const std::array<Weights, D>& across, int begin, int end, std::vector<float>& row) {
    row.assign(static_cast<std::size_t>(end - begin), 0);
    const int last = D == 3 ? across[1].count : 1;
    for (int k = 0; k < across[D - 1].count; ++k)
        for (int j = 0; j < last; ++j) {
            Index<D> I{};
            I[0] = begin;
            float w = across[D - 1].w[static_cast<std::size_t>(k)];
            if constexpr (D == 3) {
                I[1] = across[1].first + j;
                w *= across[1].w[static_cast<std::size_t>(j)];
            }
            I[D - 1] = across[D - 1].first + k;
            const float* from = q.at(I);
            float* to = row.data();
#pragma omp simd
            for (int i = 0; i < end - begin; ++i) to[i] += w * from[i];
        }
}

std::vector<float>& scratch_row() {
    thread_local std::vector<float> row;  // grows, never shrinks
    return row;
}

}  // namespace

template <int D>
void restrict_faces(const Level<D>& fine, const Faces<D>& from, const Level<D>& coarse, Faces<D>& to) {
    for_each_row_of(coarse, [&](int a, const Index<D>& first, int count) {
        std::array<Weights, D> across;
        for (int d = 1; d < D; ++d)
            across[static_cast<std::size_t>(d)] = collected(first[d], d == a, fine.halved[static_cast<std::size_t>(d)]);
        std::vector<float>& row = scratch_row();
        const Weights begin = collected(first[0], a == 0, fine.halved[0]);
        const Weights end = collected(first[0] + count - 1, a == 0, fine.halved[0]);
        combine<D>(from[a], across, begin.first, end.first + end.count, row);
        float* result = to[a].at(first);
        const float *q = row.data(), *w = begin.w.data();
        if (!fine.halved[0])
            std::copy_n(q, count, result);
        else if (a == 0)
            for (int i = 0; i < count; ++i) result[i] = w[0] * q[2 * i] + w[1] * q[2 * i + 1] + w[2] * q[2 * i + 2];
        else
            for (int i = 0; i < count; ++i) result[i] = w[0] * (q[2 * i] + q[2 * i + 3]) + w[1] * (q[2 * i + 1] + q[2 * i + 2]);
    });
}

template <int D>
void add_prolonged(const Level<D>& coarse, const Faces<D>& from, const Level<D>& fine, Faces<D>& x) {
    for_each_row_of(fine, [&](int a, const Index<D>& first, int count) {
        std::array<Weights, D> across;
        for (int d = 1; d < D; ++d)
            across[static_cast<std::size_t>(d)] = interpolated(first[d], d == a, fine.halved[static_cast<std::size_t>(d)]);
        std::vector<float>& row = scratch_row();
        const int begin = fine.halved[0] ? -1 : 0;
        combine<D>(from[a], across, begin, coarse.cells[0] + 2, row);
        const float *q = row.data() - begin, *inverse = fine.inverse[a].at(first);
        float* to = x[a].at(first);
        for (int i = 0; i < count; ++i) {
            const int f = first[0] + i, half = f / 2;
            float value = 0;
            if (!fine.halved[0])
                value = q[f];
            else if (a == 0)
                value = f % 2 == 0 ? q[half] : 0.5f * (q[half] + q[half + 1]);
            else
                value = 0.75f * q[half] + 0.25f * q[half - 1 + 2 * (f % 2)];
            to[i] += inverse[i] == 0 ? 0 : value;
        }
    });
}

#define WEIR_INSTANTIATE(D)                                                                     \
    template void restrict_faces(const Level<D>&, const Faces<D>&, const Level<D>&, Faces<D>&); \
    template void add_prolonged(const Level<D>&, const Faces<D>&, const Level<D>&, Faces<D>&);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::mac::viscous
