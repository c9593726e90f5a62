// Bodies out of a line of TOML, for the tests.
#pragma once
#include "rigid/bodies.hpp"
#include "support/test.hpp"

#include <fmt/format.h>

namespace weir::test {

/// A scene of 4 m by 4 m (by 4 m) that knows nothing but bodies and solids.
inline scene::Scene body_scene(int dim, const std::string& lines) {
    static const std::vector<scene::SolverSchema> schemas{
        {.name = "bodies", .doc = "Bodies alone.", .keys = {rigid::bodies_key(), rigid::joints_key()}}};
    return scene::parse(fmt::format("solver = \"bodies\"\ndim = {0}\ngrid = {{ cells = {1}, size = {2} }}\ntime = {{ end = 1.0 }}\n{3}\n",
                                    dim, dim == 2 ? "[40, 40]" : "[40, 40, 40]", dim == 2 ? "[4.0, 4.0]" : "[4.0, 4.0, 4.0]", lines),
                        "bodies.toml", schemas);
}

/// The table of a shape: the first body of a scene.
inline scene::Table shape_table(int dim, const std::string& shape) {
    return body_scene(dim, "bodies = [ { density = 1.0, " + shape + " } ]").root().tables("bodies")[0];
}

/// Bodies under gravity in a box, with solids of the scene.
template <int D>
struct Dry {
    rigid::Bodies<D> bodies;
    geometry::Solids<D> solids;
    rigid::Contacts<D> contacts;
    rigid::Mobility mobility;
    Vec<D> gravity{};
    real time = 0;

    explicit Dry(const std::string& lines, real g = 9.81) : Dry(body_scene(D, lines), g) {}
    Dry(const scene::Scene& scene, real g) : bodies(scene) {
        if (scene.has("solids")) solids = geometry::Solids<D>(scene.root().tables("solids"));
        bodies.join(solids);
        gravity[1] = -g;
    }
    void step(real dt) {
        for (auto& body : bodies.all()) body.advance_free(dt, gravity);
        bodies.place(solids);
        const std::size_t n = rigid::freedoms<D>;
        std::vector<real> v(n * bodies.count());
        for (std::size_t b = 0; b < bodies.count(); ++b)
            for (std::size_t k = 0; k < n; ++k) v[b * n + k] = bodies[b].velocity[k] + (k < D && !bodies[b].held[k] ? dt * gravity[k] : 0);
        rigid::dry_mobility(bodies.all(), mobility);
        contacts.find(bodies.all(), bodies.surroundings(solids));
        for (auto& body : bodies.all()) body.touches = false;
        contacts.resolve(bodies.all(), mobility, v, dt, norm(gravity));
        for (std::size_t b = 0; b < bodies.count(); ++b)
            for (std::size_t k = 0; k < n; ++k) bodies[b].velocity[k] = v[b * n + k];
        time += dt;
    }
    real energy() const {
        real e = 0;
        for (const auto& b : bodies.all()) e += b.kinetic_energy() - b.mass * dot(gravity, b.at);
        return e;
    }
};

}  // namespace weir::test
