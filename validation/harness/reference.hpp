// What a run is compared with: exact fields, published tables, single numbers. A reference is made from the scene's numbers and the
// case's data files; it sees core, scene and GSL, never a solver, so that it cannot share a solver's bugs.
//
// To add one: write `REFERENCE(taylor_green) { ... return ref; }` in validation/references/ and add its name to references/registry.cpp.
#pragma once
#include "scene/scene.hpp"
#include "validation/harness/curve.hpp"

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace weir::validation {

/// Exact fields of position [m] and time [s]. In 2D the third coordinate is 0 and the third component is not looked at.
using ScalarField = std::function<real(const Vec<3>& x, real t)>;
using VectorField = std::function<Vec<3>(const Vec<3>& x, real t)>;

struct Reference {
    std::string source;                               // citation, shown in the report: "Taylor & Green 1937"
    std::map<std::string, ScalarField> scalars = {};  // by field name: "pressure", "temperature", ...
    std::map<std::string, VectorField> vectors = {};  // "velocity"
    std::map<std::string, Curve> curves = {};         // published tables, exact profiles, exact histories
    std::map<std::string, real> numbers = {};         // "nusselt", "frequency", ...
    std::set<std::string> up_to_a_constant = {};      // fields whose mean means nothing (pressure in a closed box): both means are removed
    std::function<bool(const Vec<3>& x, real t)> covers = {};  // where the fields hold; empty: everywhere

    const ScalarField& scalar(const std::string& field) const { return find(scalars, field, "scalar field"); }
    const VectorField& vector(const std::string& field) const { return find(vectors, field, "vector field"); }
    const Curve& curve(const std::string& name) const { return find(curves, name, "curve"); }
    real number(const std::string& name) const { return find(numbers, name, "number"); }

private:
    template <class T>
    const T& find(const std::map<std::string, T>& in, const std::string& name, const char* what) const {
        const auto at = in.find(name);
        if (at == in.end()) throw BadInput(std::string("the reference gives no ") + what + " \"" + name + "\"");
        return at->second;
    }
};

/// One entry of the list of known references. `data` is the case's folder of tables, cases/<name>/data.
struct ReferenceKind {
    std::string name;
    Reference (*make)(const scene::Scene& scene, const std::filesystem::path& data);
};

/// Every reference by name; defined in validation/references/registry.cpp.
const std::vector<ReferenceKind>& references();

}  // namespace weir::validation

/// Head of the function that makes reference `name`; its body sees `scene` and `data` and returns a Reference.
#define REFERENCE(name)                                                                            \
    weir::validation::Reference name##_reference([[maybe_unused]] const weir::scene::Scene& scene, \
                                                 [[maybe_unused]] const std::filesystem::path& data)
