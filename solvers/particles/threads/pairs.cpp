#include "particles/threads/pairs.hpp"

#include "particles/state/fluid.hpp"

#include <algorithm>
#include <limits>

namespace weir::particles {

namespace {

constexpr float stale_value = std::numeric_limits<float>::quiet_NaN();

}  // namespace

/// Finds the particles with images, in the order of one process.
void Pairs::list_near_sides(const Coordinates& x, int count, const Box& particles, real radius, const real* place) {
    near_sides_.clear();
    const auto is_near = [&](int i) {
        for (std::size_t a = 0; a < 3; ++a) {
            if (!x[a] || frame_.period[a] == 0) continue;
            const real band = frame_.band(a, particles, radius), lo = frame_.lo[a];
            if (x[a][i] < lo + band || x[a][i] > lo + frame_.period[a] - band) return true;
        }
        return false;
    };
    for (int i = 0; i < count; ++i)
        if (is_near(i)) near_sides_.push_back(i);
    if (place) std::sort(near_sides_.begin(), near_sides_.end(), [&](int i, int j) { return place[i] < place[j]; });
}

/// Makes an image of each particle near a periodic side; corners follow because an axis also copies the images of previous axes.
void Pairs::make_images(const Coordinates& x, int count, const Box& particles, real radius, const real* place) {
    image_owner_.clear();
    image_shift_.clear();
    list_near_sides(x, count, particles, radius, place);
    for (std::size_t a = 0; a < 3; ++a)
        if (x[a]) with_images_[a].assign(x[a], x[a] + count);
    for (std::size_t a = 0; a < 3; ++a) {
        const real period = frame_.period[a], lo = frame_.lo[a];
        if (!x[a] || period == 0) continue;
        const real band = frame_.band(a, particles, radius);
        const auto copy = [&](std::size_t i, real shift) {
            const bool first_hand = i < static_cast<std::size_t>(count);
            image_owner_.push_back(first_hand ? static_cast<int>(i) : image_owner_[i - static_cast<std::size_t>(count)]);
            auto moved = first_hand ? std::array<float, 3>{0, 0, 0} : image_shift_[i - static_cast<std::size_t>(count)];
            moved[a] += static_cast<float>(shift);
            image_shift_.push_back(moved);
            for (std::size_t b = 0; b < 3; ++b)
                if (x[b]) with_images_[b].push_back(with_images_[b][i] + (a == b ? shift : 0));
        };
        const auto copy_near = [&](std::size_t i) {
            const real here = with_images_[a][i];
            if (here < lo + band) copy(i, period);
            if (here > lo + period - band) copy(i, -period);
        };
        const auto before = with_images_[a].size();
        for (const int i : near_sides_) copy_near(static_cast<std::size_t>(i));
        for (auto i = static_cast<std::size_t>(count); i < before; ++i) copy_near(i);
    }
}

void Pairs::fit(std::vector<float>& numbers, int per_particle) const {
    const auto needed = static_cast<std::size_t>(size() + 2 * table_.lanes) * static_cast<std::size_t>(per_particle);
    if (numbers.size() < needed) numbers.resize(needed + needed / 8);
}

void Pairs::place_dummies(float* four) const {
    for (int k = size(); k < size() + table_.lanes; ++k) {
        for (int a = 0; a < 3; ++a) four[4 * k + a] = dummy_position;
        four[4 * k + 3] = 0;
    }
}

void Pairs::find(const Coordinates& x, int count, real radius) {
    particles_ = total_ = count;
    Coordinates all = x;
    const Box box = cells_.box(x, count);
    if (frame_.periodic()) {
        make_images(x, count, box, radius, nullptr);
        for (std::size_t a = 0; a < 3; ++a)
            if (x[a]) all[a] = with_images_[a].data();
    }
    cells_.sort(all, count + static_cast<int>(image_owner_.size()), frame_.cover(box, count, radius));
    shares_.own_all(size());
    finish(all, radius);
}

void Pairs::find(const Coordinates& x, int count, real radius, const Held& held) {
    particles_ = count, total_ = held.total;
    Coordinates all = x;
    if (frame_.periodic()) {
        make_images(x, count, held.box, radius, held.place);
        for (std::size_t a = 0; a < 3; ++a)
            if (x[a]) all[a] = with_images_[a].data();
    }
    const auto [first, last] = held.cut->read(communicator().rank());
    cells_.sort(all, count + static_cast<int>(image_owner_.size()), frame_.cover(held.box, held.total, radius), first, last);
    cells_.order_cells([&](int i, int j) { return i < count && j < count ? held.place[i] < held.place[j] : i < j; });
    shares_.set(*held.cut, cells_);
    finish(all, radius);
}

void Pairs::finish(const Coordinates& all, real radius) {
    place(all);
    link_images();
    shares_.find_halos(cells_, particles_, links_);
    list_.build(table_, {axis_[0].data(), axis_[1].data(), axis_[2].data()}, cells_, static_cast<float>(radius), shares_.own());
}

/// Copies sorted positions to the arrays of the passes.
void Pairs::place(const Coordinates& all) {
    owner_.resize(static_cast<std::size_t>(size()));
    fit(a_, 4);
    fit(b_, 4);
    for (auto& axis : axis_) fit(axis, 1);
    if (communicator().poisons()) std::fill(a_.begin(), a_.end(), stale_value), std::fill(axis_[0].begin(), axis_[0].end(), stale_value);
    each_anywhere([&](int k) {
        const int i = cells_.order()[static_cast<std::size_t>(k)];
        owner_[static_cast<std::size_t>(k)] = i < particles_ ? i : image_owner_[static_cast<std::size_t>(i - particles_)];
        if (!shares_.read().has(k)) return;
        for (int a = 0; a < 3; ++a) {
            const real* axis = all[static_cast<std::size_t>(a)];
            const float here = axis ? local(axis[i], a) : 0;
            a_[static_cast<std::size_t>(4 * k + a)] = here;
            axis_[static_cast<std::size_t>(a)][static_cast<std::size_t>(k)] = here;
        }
        a_[static_cast<std::size_t>(4 * k + 3)] = 0;
    });
    place_dummies(a_.data());
    place_dummies(b_.data());
}

void Pairs::link_images() {
    links_.clear();
    if (images() == 0) return;
    sorted_.resize(static_cast<std::size_t>(particles_));
    for (int k = 0; k < size(); ++k)
        if (!is_image(k)) sorted_[static_cast<std::size_t>(owner(k))] = k;
    for (int k = 0; k < size(); ++k)
        if (is_image(k))
            links_.push_back({k, sorted_[static_cast<std::size_t>(owner(k))], cells_.order()[static_cast<std::size_t>(k)] - particles_});
}

void Pairs::refresh(float* four, bool moves) {
    shares_.exchange<float>(
        4, [&](int k, float* to) { std::copy_n(four + 4 * k, 4, to); },
        [&](int k, const float* from) { std::copy_n(from, 4, four + 4 * k); }, [&](int k) { std::fill_n(four + 4 * k, 4, stale_value); });
    for (const auto& [image, from, which] : links_)
        for (int c = 0; c < 4; ++c) {
            const float shift = moves && c < 3 ? image_shift_[static_cast<std::size_t>(which)][static_cast<std::size_t>(c)] : 0;
            four[4 * image + c] = four[4 * from + c] + shift;
        }
}

void Pairs::share(StateArrays state) {
    shares_.exchange<real>(
        static_cast<int>(state.size()),
        [&](int k, real* to) {
            for (const auto* f : state) *to++ = (*f)[static_cast<std::size_t>(owner(k))];
        },
        [&](int k, const real* from) {
            for (auto* f : state) (*f)[static_cast<std::size_t>(owner(k))] = *from++;
        },
        [](int) {});
}

void Pairs::share(std::vector<float>& sorted) {
    shares_.exchange<float>(
        1, [&](int k, float* to) { *to = sorted[static_cast<std::size_t>(k)]; },
        [&](int k, const float* from) { sorted[static_cast<std::size_t>(k)] = *from; },
        [&](int k) { sorted[static_cast<std::size_t>(k)] = stale_value; });
}

real Pairs::largest(real own) const { return shares_.several() ? detail::largest_of(of_ranks(own), communicator().ranks()) : own; }

const std::vector<int>& Pairs::particle_order() {
    if (images() == 0 && !shares_.several()) return cells_.order();
    sorted_.clear();  // valid as long as no particles were added since find()
    for (int k = shares_.own().begin; k < shares_.own().end; ++k)
        if (!is_image(k)) sorted_.push_back(owner(k));
    return sorted_;
}

Pairs::NeighbourCounts Pairs::neighbour_counts() const {
    const auto& counts = list_.neighbours();
    if (total_ == 0 || (counts.empty() && !shares_.several())) return {};  // a rank may own none, but the sum is collective
    const auto& own = shares_.own();
    const auto count = [&](int k) {
        return is_image(own.begin + k) ? 0.0 : static_cast<real>(counts[static_cast<std::size_t>(own.begin + k)]);
    };
    const int counted = counts.empty() ? 0 : own.count();
    std::vector<real> sums{block_sum(counted, count)};  // of integers, whose sum is independent of the order
    if (shares_.several()) sums = of_ranks(sums[0]);
    return {std::accumulate(sums.begin(), sums.end(), 0.0) / total_, largest(block_max(counted, count))};
}

std::size_t Pairs::bytes() const {
    return cells_.bytes() + list_.bytes() + shares_.bytes() + (a_.capacity() + b_.capacity() + 3 * axis_[0].capacity()) * sizeof(float) +
           owner_.capacity() * sizeof(int);
}

}  // namespace weir::particles
