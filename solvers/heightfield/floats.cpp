// The columns that bodies cover, their depths and stiffness, and the forces on the bodies.
#include "heightfield/floats.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace weir::heightfield {

Floats::Floats(std::vector<std::unique_ptr<Body>> bodies, const Plane& plane, const Field& bed, const Field& still_depth, real g, real rho,
               bool periodic_x, bool periodic_z)
    : bodies_(std::move(bodies)),
      plane_(plane),
      bed_(bed),
      depth_(still_depth),
      g_(g),
      rho_(rho),
      periodic_x_(periodic_x),
      periodic_z_(periodic_z),
      pushed_(bodies_.size()) {
    if (!bodies_.empty()) place_of_.assign(plane.count(), -1);
    stiff_.resize(bodies_.size()), given_.resize(bodies_.size());
}

void Floats::add(std::size_t column, real water, const Field& surface, const Field& rate) {
    place_of_[column] = static_cast<std::ptrdiff_t>(covered_.size());
    Covered c;
    c.column = column, c.water = water, c.surface = surface[column], c.rate = rate[column];
    covered_.push_back(c);
}

/// Finds the columns that bodies cover at time t, followed by those covered only before.
void Floats::locate(real t, const Field& surface, const Field& rate) {
    for (Covered& c : covered_) c.surface = surface[c.column], c.rate = rate[c.column];
    contacts_.clear();
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        covers_.clear();
        bodies_[b]->move(t, covers_);
        const real height = bodies_[b]->height();
        if (bodies_[b]->mass() < infinity) see_whole(b);
        for (const Cover& c : covers_) {
            if (place_of_[c.column] < 0) add(c.column, surface[c.column] - bed_[c.column], surface, rate);
            if (depth_[c.column] > 0 && !(c.underside + height > bed_[c.column]))
                throw NumericalFailure("float", fmt::format("object {} is in contact with the bed: there is no water below it", b));
            const bool clings = covered_[static_cast<std::size_t>(place_of_[c.column])].clings && !(bodies_[b]->mass() < infinity);
            const bool touches = clings || surface[c.column] > c.underside + height;
            contacts_.push_back({static_cast<std::size_t>(place_of_[c.column]), b, c.part, c.underside, touches});
        }
    }
    for (std::vector<real>* f : {&x_, &r_, &p_, &ap_, &diagonal_, &free_, &gap_, &part_}) f->assign(covered_.size(), 0);
}

/// A floating body that is not wholly above columns would sink as if it leaked.
void Floats::see_whole(std::size_t b) const {
    const Vec<3> size = bodies_[b]->size();
    const real area = size[0] * (plane_.dim == 3 ? size[2] : 1);
    real covered = 0;
    for (const Cover& c : covers_) covered += c.part * plane_.area();
    if (covered < (1 - 1e-6) * area) throw NumericalFailure("float", fmt::format("object {} has left the domain", b));
}

/// Depths of water below bodies, and between them.
void Floats::see_depths() {
    std::fill(free_.begin(), free_.end(), 1.0);
    std::fill(gap_.begin(), gap_.end(), 0.0);
    for (const Contact& c : contacts_) {
        const std::size_t column = covered_[c.place].column;
        free_[c.place] -= c.part;
        gap_[c.place] += c.part * (c.underside + bodies_[c.body]->height() - bed_[column]);
    }
    for (std::size_t i = 0; i < covered_.size(); ++i) {
        if (free_[i] < -1e-9) throw NumericalFailure("float", "two objects overlap");
        gap_[i] += free_[i] * depth_[covered_[i].column];
    }
}

void Floats::set_stiffness(Stiffness& k) {
    see_depths();
    const int nx = plane_.nx, nz = plane_.nz;
    const auto depth = [&](std::size_t c) { return place_of_[c] < 0 ? depth_[c] : gap_[static_cast<std::size_t>(place_of_[c])]; };
    const auto between = [&](std::size_t a, std::size_t b, real d) {
        return depth_[a] > 0 && depth_[b] > 0 ? g_ * 0.5 * (depth(a) + depth(b)) / (d * d) : 0;
    };
    for (const Covered& c : covered_) {
        const int i = static_cast<int>(c.column % static_cast<std::size_t>(nx)),
                  r = static_cast<int>(c.column / static_cast<std::size_t>(nx));
        const std::size_t row = static_cast<std::size_t>(r) * static_cast<std::size_t>(nx + 1);
        for (const int f : {i, i + 1}) {
            const bool end = f == 0 || f == nx;
            if (end && !periodic_x_) continue;
            const real value = between(plane_.at((f - 1 + nx) % nx, r), plane_.at(f % nx, r), plane_.dx);
            k.x[row + static_cast<std::size_t>(f)] = value;
            if (end) k.x[row + static_cast<std::size_t>(nx - f)] = value;
        }
        for (const int f : {r, r + 1}) {
            const bool end = f == 0 || f == nz;
            if (plane_.dim == 2 || (end && !periodic_z_)) continue;
            const real value = between(plane_.at(i, (f - 1 + nz) % nz), plane_.at(i, f % nz), plane_.dz);
            k.z[plane_.at(i, f)] = value;
            if (end) k.z[plane_.at(i, nz - f)] = value;
        }
    }
}

void Floats::see_neighbours(const Field& surface, const Stiffness& k) {
    const int nx = plane_.nx, nz = plane_.nz;
    for (Covered& c : covered_) {
        const int i = static_cast<int>(c.column % static_cast<std::size_t>(nx)),
                  r = static_cast<int>(c.column / static_cast<std::size_t>(nx));
        const std::size_t row = static_cast<std::size_t>(r) * static_cast<std::size_t>(nx + 1) + static_cast<std::size_t>(i);
        c.k = {k.x[row], k.x[row + 1], k.z[c.column], k.z[c.column + static_cast<std::size_t>(nx)]};
        c.beside = {plane_.at((i - 1 + nx) % nx, r), plane_.at((i + 1) % nx, r), plane_.at(i, (r - 1 + nz) % nz),
                    plane_.at(i, (r + 1) % nz)};
        for (std::size_t f = 0; f < 4; ++f) c.surface_beside[f] = surface[c.beside[f]], c.place_beside[f] = place_of_[c.beside[f]];
    }
}

void Floats::enter(const Field& surface, const Field& rate, Stiffness& k) {
    locate(0, surface, rate);
    for (const Contact& c : contacts_) {
        Covered& below = covered_[c.place];
        if (c.touches) below.water -= c.part * (below.surface - c.underside - bodies_[c.body]->height());
    }
    set_stiffness(k);
    see_neighbours(surface, k);
    for (std::size_t i = 0; i < covered_.size(); ++i) x_[i] = covered_[i].surface;
    tell();
}

void Floats::before(real t, const Field& surface, const Field& rate, Stiffness& k) {
    locate(t, surface, rate);
    set_stiffness(k);
    see_neighbours(surface, k);
}

/// Displaced volume and forces. Along x and z the pressure force rho g d^2/2 acts on vertical sides of draught d.
void Floats::tell() {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        Pushed& push = pushed_[b];
        push = {};
        const real height = bodies_[b]->height();
        std::fill(part_.begin(), part_.end(), 0.0);
        std::fill(p_.begin(), p_.end(), 0.0);
        for (const Contact& c : contacts_) {
            if (c.body != b || !c.touches) continue;
            const real depth = x_[c.place] - c.underside - height;
            push.displaced += plane_.area() * c.part * depth;
            part_[c.place] = c.part;
            p_[c.place] = 0.5 * rho_ * g_ * depth * depth;
        }
        push.up = rho_ * g_ * push.displaced;
        for (std::size_t i = 0; i < covered_.size(); ++i)
            for (std::size_t f = 0; f < 4; ++f) {
                const std::ptrdiff_t place = covered_[i].place_beside[f];
                const real there = place >= 0 ? part_[static_cast<std::size_t>(place)] : 0;
                if (!(part_[i] > there)) continue;  // each face once, from the side with more coverage
                const real q = place >= 0 ? p_[static_cast<std::size_t>(place)] : 0;
                const real force = (part_[i] * p_[i] + there * q) / (part_[i] + there) * (part_[i] - there);
                (f < 2 ? push.along_x : push.along_z) += (f % 2 == 0 ? force : -force) * (f < 2 ? plane_.dz : plane_.dx);
            }
    }
}

/// Columns that are no longer covered become ordinary columns.
void Floats::forget_free_columns() {
    std::fill(part_.begin(), part_.end(), 0.0);
    for (const Contact& c : contacts_) part_[c.place] = 1;
    bool all = true;
    for (const real p : part_) all = all && p > 0;
    if (all) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < covered_.size(); ++i) {
        place_of_[covered_[i].column] = part_[i] > 0 ? static_cast<std::ptrdiff_t>(kept) : -1;
        for (Contact& c : contacts_)
            if (c.place == i) c.place = kept;
        if (part_[i] > 0) covered_[kept++] = covered_[i];
    }
    covered_.resize(kept);
}

void Floats::displaced(const Field& surface, Field& to) const {
    to.fill(0);
    for (const Contact& c : contacts_) {
        const std::size_t column = covered_[c.place].column;
        if (c.touches) to[column] += c.part * (surface[column] - c.underside - bodies_[c.body]->height());
    }
}

real Floats::pace(real t) const {
    real most = 0;
    for (const auto& body : bodies_) most = std::max(most, body->pace(t));
    return most;
}

/// Uses the neighbouring columns: below a body the height is equivalent to the pressure, which a fast object raises far.
real Floats::over_top(const Field& surface) const {
    real most = 0;
    for (const Contact& c : contacts_) {
        const Covered& below = covered_[c.place];
        const real top = c.underside + bodies_[c.body]->height() + bodies_[c.body]->top();
        for (std::size_t f = 0; f < 4; ++f)
            if (below.place_beside[f] < 0) most = std::max(most, surface[below.beside[f]] - top);
    }
    return most;
}

void Floats::show(FieldSet& fields) const {
    for (std::vector<real>& f : shown_) f.resize(bodies_.size());
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        const Vec<3> middle = bodies_[b]->middle(), size = bodies_[b]->size();
        for (std::size_t a = 0; a < 3; ++a) shown_[a][b] = middle[static_cast<int>(a)], shown_[3 + a][b] = size[static_cast<int>(a)];
    }
    const auto add = [&](const char* name, std::size_t first) {
        FieldView field{name, "m", Where::particle, box_set_name, {shown_[first], shown_[first + 1]}};
        if (plane_.dim == 3) field.data.push_back(shown_[first + 2]);
        fields.fields.push_back(std::move(field));
    };
    add("position", 0), add("size", 3);
}

real Floats::missing(const Field& surface) const {
    real sum = 0;
    for (const Covered& c : covered_) sum += c.water - (surface[c.column] - bed_[c.column]);
    return plane_.area() * sum;
}

std::size_t Floats::bytes() const {
    std::size_t total = place_of_.capacity() * sizeof(std::ptrdiff_t) + covered_.capacity() * sizeof(Covered) +
                        contacts_.capacity() * sizeof(Contact) + covers_.capacity() * sizeof(Cover);
    for (const std::vector<real>* f : {&x_, &r_, &p_, &ap_, &diagonal_, &free_, &gap_, &part_, &stiff_, &given_})
        total += f->capacity() * sizeof(real);
    for (const std::vector<real>& f : shown_) total += f.capacity() * sizeof(real);
    return total;
}

void Floats::save(Checkpoint& to) const {
    std::vector<std::size_t> columns;
    std::vector<real> water;
    std::vector<char> clings;
    for (const Covered& c : covered_) columns.push_back(c.column), water.push_back(c.water), clings.push_back(c.clings ? 1 : 0);
    to.put("covered_clings", clings);
    to.put("covered_columns", columns);
    to.put("covered_water", water);
    to.put("pushed", pushed_);
    for (std::size_t b = 0; b < bodies_.size(); ++b) bodies_[b]->save(to, fmt::format("float{}_", b));
}

void Floats::restore(const Checkpoint& from, real t, const Field& surface, const Field& rate, Stiffness& k) {
    contacts_.clear();
    set_stiffness(k);  // open water again at the bodies' old positions
    for (const Covered& c : covered_) place_of_[c.column] = -1;
    covered_.clear();
    std::vector<std::size_t> columns;
    std::vector<real> water;
    from.get("covered_columns", columns);
    from.get("covered_water", water);
    std::vector<char> clings;
    from.get("covered_clings", clings);
    from.get("pushed", std::span<Pushed>(pushed_));
    if (water.size() != columns.size() || clings.size() != columns.size())
        throw std::runtime_error("checkpoint blocks \"covered_columns\", \"covered_water\" and \"covered_clings\" are not of one length");
    Checkpoint::require_finite("covered_water", water);
    for (std::size_t i = 0; i < columns.size(); ++i) {
        if (columns[i] >= place_of_.size() || place_of_[columns[i]] >= 0)
            throw std::runtime_error("checkpoint block \"covered_columns\" names column " + std::to_string(columns[i]) + " of " +
                                     std::to_string(place_of_.size()) + ", or one twice");
        add(columns[i], water[i], surface, rate);
        covered_.back().clings = clings[i] != 0;
    }
    for (std::size_t b = 0; b < bodies_.size(); ++b) bodies_[b]->restore(from, fmt::format("float{}_", b));
    locate(t, surface, rate);
}

}  // namespace weir::heightfield
