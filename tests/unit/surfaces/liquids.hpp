// Liquids as clouds of particles of spacing 1, and their surfaces.
#pragma once
#include "core/parallel.hpp"
#include "sim/registry.hpp"
#include "surfaces/measure.hpp"
#include "surfaces/reconstruction.hpp"

#include <array>
#include <random>
#include <string>
#include <vector>

namespace weir::test {

using namespace surfaces;

struct Liquid {
    std::array<std::vector<real>, 3> x, v{};
    int domain = 48;  // along each axis [spacings]
    void put(const Vec<3>& at) {
        for (int a = 0; a < 3; ++a)
            x[static_cast<std::size_t>(a)].push_back(at[a]), v[static_cast<std::size_t>(a)].push_back(at[(a + 1) % 3]);
    }
    int count() const { return static_cast<int>(x[0].size()); }
    FieldSet fields() const {
        FieldSet set;
        set.grid = {3, {domain, domain, domain}, {0, 0, 0}, {1, 1, 1}};
        set.fields = {{"position", "m", Where::particle, particle_set_name, {x[0], x[1], x[2]}},
                      {"velocity", "m/s", Where::particle, particle_set_name, {v[0], v[1], v[2]}}};
        return set;
    }
};

/// Centres of cells where inside(x) holds, each moved by at most `jitter` along each axis.
template <class Inside>
Liquid fill(int domain, const Inside& inside, real jitter = 0, unsigned seed = 1) {
    Liquid liquid;
    liquid.domain = domain;
    std::mt19937 random(seed);
    std::uniform_real_distribution<real> off(-jitter, jitter);
    for (int k = 0; k < domain; ++k)
        for (int j = 0; j < domain; ++j)
            for (int i = 0; i < domain; ++i) {
                const Vec<3> x{{i + 0.5, j + 0.5, k + 0.5}};
                if (inside(x)) liquid.put(jitter > 0 ? x + Vec<3>{{off(random), off(random), off(random)}} : x);
            }
    return liquid;
}

/// Particles anywhere in the middle of the domain, so thin that drops, films and holes of all kinds appear.
inline Liquid spray(int domain, int count, unsigned seed) {
    Liquid liquid;
    liquid.domain = domain;
    std::mt19937 random(seed);
    std::uniform_real_distribution<real> at(0.2 * domain, 0.8 * domain);
    for (int i = 0; i < count; ++i) liquid.put({{at(random), at(random), at(random)}});
    return liquid;
}

inline scene::Scene scene_of(int domain, const std::string& more = "") {
    const std::string n = std::to_string(domain), size = "[" + n + ", " + n + ", " + n + "]";
    return scene::parse("solver = \"pbf\"\ndim = 3\ngrid = { cells = " + size + ", size = " + size + " }\ntime = { end = 1.0 }\n" + more,
                        "test.toml", sim::schemas());
}

inline const std::array<Method, 3> of_particles{Method::zhu_bridson, Method::anisotropic, Method::density};
inline Options usual(Method method, real cell = 1) { return {method, cell, method == Method::density ? 5 : 0}; }

inline SurfaceMesh surface_of(const Liquid& liquid, const Options& options, const std::string& more = "") {
    Reconstruction made(options, scene_of(liquid.domain, more));
    return made.make(liquid.fields(), 0);
}

}  // namespace weir::test
