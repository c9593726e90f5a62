// Particles sorted into cells, the blocks of samples near them, and the density and moments of their neighbours.
#include "surfaces/particle_field.hpp"

#include "core/parallel.hpp"
#include "surfaces/reference.hpp"

#include <algorithm>
#include <cmath>

namespace weir::surfaces {

namespace {

constexpr int lanes = 8;
/// A cell is full if it has at least this fraction of the particles of a liquid at rest.
constexpr float full_part = 0.5F;

int blocks_along(int samples, int length) { return (samples + length - 1) / length; }

}  // namespace

void ParticleField::lay(const particles::Box& box, std::int64_t count, real spacing, const Samples& samples) {
    grid_ = particles::cover_box(box, static_cast<int>(count), reach * spacing);
    origin_ = samples.first;
    step_ = static_cast<float>(samples.spacing[0] / spacing);
    cell_width_ = static_cast<float>(1 / (grid_.per_cell * spacing));
    for (std::size_t a = 0; a < 3; ++a) cell_origin_[a] = static_cast<float>((grid_.origin[a] - origin_[a]) / spacing);
}

PlaneRange ParticleField::cells_read(const Samples& samples, PlaneRange planes) const {
    if (planes.begin >= planes.end) return {0, 0};
    const int count = samples.n[slowest()], cells = grid_.cells[slowest()];
    const auto at = [&](int plane) { return step_ * static_cast<float>(plane); };
    // particles within reach, and those needed for their neighbour sums
    PlaneRange read = cells_between(slowest(), at(planes.begin) - outermost() - step_, at(planes.end) + outermost() + step_);
    const float radius = method_ == Method::anisotropic ? static_cast<float>(far_reach) : static_cast<float>(reach);
    const int measured = method_ == Method::zhu_bridson ? 0 : static_cast<int>(std::ceil(radius / cell_width_)) + 1;
    read.begin -= measured, read.end += measured;
    // all cells that decide whether a block is deep in the liquid
    const int length = Block::length[slowest()], first = planes.begin / length * length;
    const int last = std::min(count, (planes.end + length - 1) / length * length);
    const PlaneRange blocks = cells_between(slowest(), at(first), at(last - 1));
    return {std::max(0, std::min(read.begin, blocks.begin - 1)), std::min(cells, std::max(read.end, blocks.end + 1))};
}

int ParticleField::cell_plane(real x) const {
    const std::size_t a = slowest();
    return std::min(static_cast<int>((x - grid_.origin[a]) * grid_.per_cell), grid_.cells[a] - 1);
}

void ParticleField::compute(const Cloud& cloud, Samples& samples) {
    cloud_ = &cloud;
    blocks_.clear();
    if (samples.own.begin >= samples.own.end) return;
    const bool all = samples.own == PlaneRange{0, samples.n[slowest()]};
    read_ = all ? PlaneRange{0, grid_.cells[slowest()]} : cells_read(samples, samples.own);
    sort(cloud);
    find_deep_cells();
    find_blocks(samples);
    measure_particles();
#pragma omp parallel for schedule(dynamic, 4) num_threads(threads())
    for (int b = 0; b < static_cast<int>(blocks_.size()); ++b) fill(blocks_[static_cast<std::size_t>(b)], samples);
}

float ParticleField::outermost() const {
    return static_cast<float>(method_ == Method::anisotropic ? far_reach * longest + farthest_move : reach);
}

void ParticleField::sort(const Cloud& cloud) {
    const int plane = grid_.cells[0] * grid_.cells[1];
    if (flat_)  // its rows of cells span many layers
        cells_.sort(cloud.coordinates(), cloud.count(), grid_);
    else
        cells_.sort(cloud.coordinates(), cloud.count(), grid_, plane * read_.begin, plane * read_.end);
    const std::vector<int>& order = cells_.order();
    for (std::size_t a = 0; a < 3; ++a) {
        x_[a].resize(order.size());
        const real per_spacing = 1 / cloud.spacing;
        parallel_for(0, cloud.count(), [&](int i) {
            const auto at = static_cast<std::size_t>(i);
            x_[a][at] = static_cast<float>((cloud.x[a][static_cast<std::size_t>(order[at])] - origin_[a]) * per_spacing);
        });
    }
}

/// A cell is deep where it and all its neighbours are full: its samples are inside.
void ParticleField::find_deep_cells() {
    const auto& n = grid_.cells;
    const auto& start = cells_.start();
    const float enough = full_part * cell_width_ * cell_width_ * cell_width_;
    const std::size_t count = start.size() - 1;
    full_.resize(count), deep_.assign(count, 0), needed_.assign(count, 0);
    for (std::size_t c = 0; c < count; ++c) full_[c] = static_cast<float>(start[c + 1] - start[c]) >= enough;
    const PlaneRange ks = flat_ ? PlaneRange{0, n[2]} : read_;
    parallel_for(ks.begin + 1, ks.end - 1, [&](int k) {
        for (int j = 1; j + 1 < n[1]; ++j)
            for (int i = 1; i + 1 < n[0]; ++i) {
                bool all = true;
                for (int dk = -1; dk <= 1; ++dk)
                    for (int dj = -1; dj <= 1; ++dj) {
                        const char* row = full_.data() + row_of(j + dj, k + dk) + i;
                        all = all && row[-1] && row[0] && row[1];
                    }
                deep_[row_of(j, k) + static_cast<std::size_t>(i)] = all;
            }
    });
}

std::array<float, 3> ParticleField::low(const Block& block) const {
    return {step_ * static_cast<float>(block.begin[0]), step_ * static_cast<float>(block.begin[1]),
            step_ * static_cast<float>(block.begin[2])};
}
std::array<float, 3> ParticleField::high(const Block& block) const {
    return {step_ * static_cast<float>(block.end[0] - 1), step_ * static_cast<float>(block.end[1] - 1),
            step_ * static_cast<float>(block.end[2] - 1)};
}

PlaneRange ParticleField::cells_between(std::size_t axis, float lo, float hi) const {
    // slightly more: cells were chosen in double precision, so a particle may lie beyond its cell by rounding
    constexpr float hair = 1e-3F;
    return {static_cast<int>(std::floor((lo - hair - cell_origin_[axis]) / cell_width_)),
            static_cast<int>(std::floor((hi + hair - cell_origin_[axis]) / cell_width_)) + 1};
}

ParticleField::CellBox ParticleField::cells_in(const std::array<float, 3>& lo, const std::array<float, 3>& hi) const {
    CellBox box{{}, {}, false};
    for (std::size_t a = 0; a < 3; ++a) {
        const PlaneRange cells = cells_between(a, lo[a], hi[a]);
        const PlaneRange all = a == slowest() ? read_ : PlaneRange{0, grid_.cells[a]};
        box.begin[a] = std::max(all.begin, cells.begin), box.end[a] = std::min(all.end, cells.end);
        box.beyond = box.beyond || cells.begin < 0 || cells.end > grid_.cells[a];
    }
    return box;
}

bool ParticleField::is_deep(const Block& whole) const {
    const CellBox box = cells_in(low(whole), high(whole));
    if (box.beyond) return false;
    for (int k = box.begin[2]; k < box.end[2]; ++k)
        for (int j = box.begin[1]; j < box.end[1]; ++j)
            for (int i = box.begin[0]; i < box.end[0]; ++i)
                if (!deep_[row_of(j, k) + static_cast<std::size_t>(i)]) return false;
    return true;
}

void ParticleField::find_blocks(const Samples& samples) {
    const float far = outermost();
    const float dry = method_ == Method::zhu_bridson ? -1.0F : std::max(-1.0F, profile_of(method_, flat_).depth(0.0F));
    const std::size_t cut = slowest();
    std::array<int, 3> first{0, 0, 0}, last = samples.n;
    first[cut] = samples.own.begin, last[cut] = samples.own.end;
    Block block{};
    for (int k = first[2] / Block::length[2]; k < blocks_along(last[2], Block::length[2]); ++k)
        for (int j = first[1] / Block::length[1]; j < blocks_along(last[1], Block::length[1]); ++j)
            for (int i = 0; i < blocks_along(samples.n[0], Block::length[0]); ++i) {
                const std::array<int, 3> number{i, j, k};
                for (std::size_t a = 0; a < 3; ++a) {
                    block.begin[a] = number[a] * Block::length[a];
                    block.end[a] = std::min(samples.n[a], block.begin[a] + Block::length[a]);
                }
                const bool inside = is_deep(block);  // in parallel for the whole block, too
                block.begin[cut] = std::max(block.begin[cut], first[cut]), block.end[cut] = std::min(block.end[cut], last[cut]);
                auto lo = low(block), hi = high(block);
                for (std::size_t a = 0; a < 3; ++a) lo[a] -= far, hi[a] += far;
                bool any = false;
                if (!inside) for_runs(cells_in(lo, hi), [&](int, int) { any = true; });
                block.computed = any;
                block.value = inside ? 1.0F : dry;
                blocks_.push_back(block);
                if (any) mark_needed(block);
            }
}

void ParticleField::mark_needed(const Block& block) {
    auto lo = low(block), hi = high(block);
    // one step more: a surface point may lie between the block's last sample and the next one
    for (std::size_t a = 0; a < 3; ++a) lo[a] -= outermost() + step_, hi[a] += outermost() + step_;
    const CellBox box = cells_in(lo, hi);
    for (int k = box.begin[2]; k < box.end[2]; ++k)
        for (int j = box.begin[1]; j < box.end[1]; ++j)
            for (int i = box.begin[0]; i < box.end[0]; ++i) needed_[row_of(j, k) + static_cast<std::size_t>(i)] = 1;
}

void ParticleField::measure_particles() {
    if (method_ == Method::zhu_bridson) return;
    if (method_ == Method::density) peak_.resize(x_[0].size()), crowding_.resize(x_[0].size());
    if (method_ == Method::anisotropic) blobs_.resize(x_[0].size());
    const auto& start = cells_.start();
#pragma omp parallel for schedule(dynamic, 64) num_threads(threads())
    for (int c = 0; c < static_cast<int>(needed_.size()); ++c)
        if (needed_[static_cast<std::size_t>(c)])
            for (int i = start[static_cast<std::size_t>(c)]; i < start[static_cast<std::size_t>(c) + 1]; ++i) measure(i);
}

/// Density, and for anisotropic kernels the moments, of the neighbours of one particle; vectorized, lanes are added in order.
void ParticleField::measure(int i) {
    const auto at = static_cast<std::size_t>(i);
    const bool moments = method_ == Method::anisotropic;
    const float radius = moments ? static_cast<float>(far_reach) : static_cast<float>(reach);
    const std::array<float, 3> x{x_[0][at], x_[1][at], x_[2][at]};
    // lane sums: bump, crowding, weight, 3 first, 6 second moments, count
    constexpr int sums = 13;
    alignas(64) float sum[sums][lanes] = {};
    const float per_reach2 = 1 / static_cast<float>(reach * reach), per_far2 = 1 / static_cast<float>(far_reach * far_reach);
    const auto meet = [&](int l, float dx, float dy, float dz) {
        const float d2 = dx * dx + dy * dy + dz * dz;
        const float near = std::max(0.0F, 1 - d2 * per_reach2);
        sum[0][l] += near * near * near;
        sum[1][l] += near;
        if (!moments) return;
        const float q2 = d2 * per_far2, w = std::max(0.0F, 1 - q2 * std::sqrt(q2));
        sum[2][l] += w;
        sum[3][l] += w * dx, sum[4][l] += w * dy, sum[5][l] += w * dz;
        sum[6][l] += w * dx * dx, sum[7][l] += w * dy * dy, sum[8][l] += w * dz * dz;
        sum[9][l] += w * dx * dy, sum[10][l] += w * dx * dz, sum[11][l] += w * dy * dz;
        sum[12][l] += w > 0 ? 1.0F : 0.0F;
    };
    const CellBox box = cells_in({x[0] - radius, x[1] - radius, x[2] - radius}, {x[0] + radius, x[1] + radius, x[2] + radius});
    for_runs(box, [&](int first, int behind) {
        const float *px = x_[0].data(), *py = x_[1].data(), *pz = x_[2].data();
        int j = first;
        for (; j + lanes <= behind; j += lanes)
            for (int l = 0; l < lanes; ++l) meet(l, px[j + l] - x[0], py[j + l] - x[1], pz[j + l] - x[2]);
        for (; j < behind; ++j) meet(0, px[j] - x[0], py[j] - x[1], pz[j] - x[2]);
    });
    real total[sums];
    for (int s = 0; s < sums; ++s) {
        total[s] = 0;
        for (int l = 0; l < lanes; ++l) total[s] += static_cast<real>(sum[s][l]);
    }
    const real volume = std::max(1.0, lonely_density * reach * reach * reach / (bump_norm * total[0]));
    if (!moments) {
        peak_[at] = static_cast<float>(volume * bump_norm / (reach * reach * reach));
        crowding_[at] = static_cast<float>(total[1] - 1);  // without itself
        return;
    }
    const Moments m{total[2],
                    {total[3], total[4], total[5]},
                    {total[6], total[7], total[8], total[9], total[10], total[11]},
                    static_cast<int>(total[12])};
    const Blob blob = stretched({{real(x[0]), real(x[1]), real(x[2])}}, m, volume);
    FloatBlob& to = blobs_[at];
    for (std::size_t a = 0; a < 3; ++a) to.centre[a] = static_cast<float>(blob.centre[a]), to.half[a] = static_cast<float>(blob.half[a]);
    for (std::size_t a = 0; a < 6; ++a) to.stretch[a] = static_cast<float>(blob.stretch[a]);
    to.peak = static_cast<float>(blob.peak);
}

long ParticleField::computed() const {
    long count = 0;
    for (const Block& b : blocks_)
        if (b.computed) count += long(b.end[0] - b.begin[0]) * (b.end[1] - b.begin[1]) * (b.end[2] - b.begin[2]);
    return count;
}

std::size_t ParticleField::bytes() const {
    return cells_.bytes() + 3 * x_[0].capacity() * sizeof(float) + 3 * needed_.capacity() + blocks_.capacity() * sizeof(Block) +
           (peak_.capacity() + crowding_.capacity()) * sizeof(float) + blobs_.capacity() * sizeof(FloatBlob);
}

}  // namespace weir::surfaces
