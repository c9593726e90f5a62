// Images of scenes: a walk down the table and the schema beside it. Units say how a number scales; whether a list of numbers is a place, a
// direction or an extent, its name says, and a list that no rule names stops the test.
#include "metamorphic/transformation.hpp"

#include "scene/formula.hpp"
#include "scene/names.hpp"
#include "scene/schema.hpp"
#include "sim/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

namespace weir::metamorphic {

using scene::Key;
using scene::Table;
using scene::Type;
using scene::Value;

Transformation Transformation::mirror(int a) {
    Transformation t;
    t.sign[static_cast<std::size_t>(a)] = -1;
    return t;
}
Transformation Transformation::exchange(int a, int b) {
    Transformation t;
    std::swap(t.axis[static_cast<std::size_t>(a)], t.axis[static_cast<std::size_t>(b)]);
    return t;
}
Transformation Transformation::cycle() {
    Transformation t;
    t.axis = {1, 2, 0};
    return t;
}
bool Transformation::turns() const { return axis != std::array<int, 3>{0, 1, 2} || sign != std::array<int, 3>{1, 1, 1}; }
int Transformation::handedness() const {
    const bool even = axis == std::array<int, 3>{0, 1, 2} || axis == std::array<int, 3>{1, 2, 0} || axis == std::array<int, 3>{2, 0, 1};
    return (even ? 1 : -1) * sign[0] * sign[1] * sign[2];
}

namespace {

const std::set<std::string> places{"min", "max", "centre", "point", "from", "to", "at", "anchor", "surface", "origin", "centre_of_mass"};
const std::set<std::string> directions{"velocity", "liquid_velocity", "g", "gradient", "value", "normal", "axis", "amplitude", "offset"};
const std::set<std::string> extents{"size", "cells"};
/// Lists and numbers that lie in the frame of the domain in a way of their own.
const std::set<std::string> tied_to_the_frame{"over", "corner", "x", "depth", "nodata", "black", "white", "file"};
/// In 2D per metre of depth: a length less than their unit says.
const std::set<std::string> per_depth{"mass", "stiffness", "damping", "power", "enclosed_vapour"};

class Rewriter {
public:
    Rewriter(const scene::Scene& scene, const Transformation& by, bool moves_domain)
        : scene_(scene), dim_(scene.dim()), by_(by), moves_domain_(moves_domain) {
        const std::string& solver = scene.solver();
        if ((solver == "waves" || solver == "closed_vessel") && (by.turns() || by.shifts())) no(solver + " stands in a frame of its own");
        if (solver == "phase_diagram" || solver == "poisson") no(solver + " has a frame and units of its own");
        if (solver == "sph" && !scene.has("scheme.sound_speed") && !scene.effect("gravity") && !by.scale.is_one())
            no("where nothing says how fast the flow is, sound travels at 10 m/s");
        if (!by.keeps_up() && (scene.solver() == "tallcell" || scene.solver() == "heightfield")) no("columns stand along y");
        if (!by.keeps_up() && scene.effect("buoyancy")) no("buoyancy acts along y");
        if (!by.keeps_up() && scene.has("heat.lift") && scene.number("heat.lift") != 0) no("heat.lift acts along y");
        if (!scene.root().tables("changes").empty()) no("it changes keys while it runs");
    }

    Table root() {
        const auto& kind = sim::kind_named(scene_.solver());
        const auto all = scene::keys_of(kind.schema);
        std::vector<const Key*> keys;
        for (const Key& key : all) keys.push_back(&key);
        return table(scene_.root(), keys, {});
    }

private:
    struct Around {
        std::string key{}, variant{}, unit{};
    };
    [[noreturn]] static void no(const std::string& why) { throw Untransformable(why); }

    static std::size_t at(int a) { return static_cast<std::size_t>(a); }

    Table table(const Table& t, const std::vector<const Key*>& keys, const Around& around) {
        require_image(t, around);
        Table out = t;
        for (const auto& name : t.keys()) {
            const auto key = std::find_if(keys.begin(), keys.end(), [&](const Key* k) { return k->name == name; });
            if (key == keys.end()) continue;  // the selector
            if (!moves_domain_ && around.key.empty() && (name == "grid" || name == "sides")) continue;
            const bool said = t.place(name).column > 0 || t.was_read(name);
            Value image = value(**key, *t.find(name), around, t);
            const bool leaf = !std::holds_alternative<Table>(image) && !std::holds_alternative<std::vector<Table>>(image);
            const bool changed = leaf && scene::to_toml(image) != scene::to_toml(*t.find(name));
            out.set(name, std::move(image), changed && said ? scene::Place{1, 1} : t.place(name));
        }
        if (around.variant == "box" && out.has("min")) order(out, "min", "max");
        if (around.key == "grid") place_domain(t, out);
        if (around.key == "sides") rename_sides(t, out);
        if (around.variant == "formula" && around.key == "velocity") turn_formulas(t, out);
        return out;
    }

    static void order(Table& out, const char* low, const char* high) {
        std::vector<double> a = std::get<std::vector<double>>(*out.find(low)), b = std::get<std::vector<double>>(*out.find(high));
        for (std::size_t d = 0; d < a.size(); ++d)
            if (a[d] > b[d]) std::swap(a[d], b[d]);
        out.set(low, a, {1, 1}), out.set(high, b, {1, 1});
    }

    /// The image of the lower corner is another corner where an axis turns round.
    void place_domain(const Table& t, Table& out) const {
        auto origin = std::get<std::vector<double>>(*t.find("origin"));
        const auto& size = std::get<std::vector<double>>(*t.find("size"));
        std::vector<double> image = origin;
        for (int a = 0; a < dim_; ++a) {
            const auto A = at(by_.axis[at(a)]);
            image[A] = by_.shift[A] + by_.scale.length * (by_.sign[at(a)] > 0 ? origin[at(a)] : -(origin[at(a)] + size[at(a)]));
        }
        out.set("origin", image, image == origin ? t.place("origin") : scene::Place{1, 1});
    }

    void rename_sides(const Table& t, Table& out) const {
        Table images = out;
        for (int a = 0; a < dim_; ++a)
            for (const bool upper : {false, true}) {
                const std::string from = side(a, upper), to = side(by_.axis[at(a)], upper == (by_.sign[at(a)] > 0));
                if (t.has(from)) images.set(to, *out.find(from), out.place(from));
            }
        out = images;
    }
    static std::string side(int a, bool upper) { return fmt::format("{}_{}", "xyz"[a], upper ? "max" : "min"); }

    /// Formulas of components: the one of the image's axis, with its sign.
    void turn_formulas(const Table& t, Table& out) const {
        for (int a = 0; a < 3; a += 2) {
            const std::string from(1, "xyz"[a]), to(1, "xyz"[by_.axis[at(a)]]);
            if (!t.has(from) || (a == 2 && dim_ == 2)) continue;
            const double factor = by_.sign[at(a)] * by_.scale.of("m/s");
            const auto& text = std::get<std::string>(*t.find(from));
            out.set(to, factor == 1 ? substituted(text) : fmt::format("{}*({})", scene::number_text(factor), substituted(text)), {1, 1});
        }
    }

    /// Refuses what stands still, or has another meaning, in its image.
    void require_image(const Table& t, const Around& around) {
        const std::string& v = around.variant;
        const bool moved = by_.turns() || by_.shifts();
        if (around.key == "substance" && v == "water" && !by_.scale.is_one()) no("the substance is water by formulas with units");
        if (v == "wave") {
            const double length = by_.scale.length * std::get<double>(*t.find("wavelength")), x = by_.shift[0] / length;
            if (!by_.keeps_up() || by_.axis[0] != 0 || x != std::round(x)) no("the shape wave stands along y, with its crest at x = 0");
        }
        if (v == "mesh" && by_.turns()) no("a mesh has no image");
        if (v == "asc" || v == "image")
            if (moved || !by_.scale.is_one()) no("terrain is read from a file");
        if (v == "taylor_green" && (by_.shifts() || (dim_ == 3 && by_.axis != std::array<int, 3>{0, 1, 2}))) no(tied(v));
        if (v == "random" && moved) no("random noise goes with the numbers of faces");
        if (v == "strain" && dim_ == 3 && by_.turns()) no("strain in 3D");
        if (v == "slotted_disk" && !by_.keeps_up()) no("the slot stands along y");
        if (v == "kovasznay" || v == "shear_layer" || v == "single_vortex" || v == "enright") no(tied(v));
    }
    static std::string tied(const std::string& what) { return what + " is a formula of the coordinates"; }

    Value value(const Key& key, const Value& v, const Around& around, const Table& in) {
        if (const auto* t = std::get_if<Table>(&v)) return key.type == Type::named ? named(*t, key) : chosen(*t, key);
        if (const auto* list = std::get_if<std::vector<Table>>(&v)) {
            std::vector<Table> out;
            for (const Table& t : *list) out.push_back(chosen(t, key));
            return out;
        }
        if (const auto* x = std::get_if<double>(&v)) return number(key, *x, around);
        if (const auto* x = std::get_if<std::vector<double>>(&v)) return numbers(key, *x, around);
        if (const auto* x = std::get_if<std::vector<std::string>>(&v)) return texts(*x);
        if (const auto* x = std::get_if<std::string>(&v)) return text(key, *x, around, in);
        return v;
    }

    Table chosen(const Table& t, const Key& key) {
        std::vector<const Key*> keys;
        for (const Key& k : key.keys) keys.push_back(&k);
        Around around{key.name, "", key.unit};
        if (!key.selector.empty() && t.has(key.selector)) {
            around.variant = std::get<std::string>(*t.find(key.selector));
            if (const auto* variant = scene::find_variant(key, around.variant))
                for (const Key& k : variant->keys) keys.push_back(&k);
        }
        return table(t, keys, around);
    }

    Table named(const Table& t, const Key& key) {
        Table out = t;
        for (const auto& variant : scene::variants_of(key)) {
            if (!t.has(variant.name)) continue;
            std::vector<const Key*> keys;
            for (const Key& k : variant.keys) keys.push_back(&k);
            out.set(variant.name, table(std::get<Table>(*t.find(variant.name)), keys, {variant.name, "", ""}), t.place(variant.name));
        }
        return out;
    }

    double factor(const Key& key, const Around& around) const {
        Dimension d = dimension_of(key.unit.empty() && (key.name == "value" || key.name == "outside") ? around.unit : key.unit);
        if (dim_ == 2 && per_depth.count(key.name)) d.length -= 1;
        return by_.scale.of(d);
    }

    Value number(const Key& key, double x, const Around& around) {
        const bool rolling = around.key == "rotating_frame" && (key.name == "rate" || key.name == "amplitude");
        const bool turning =
            rolling || key.name == "angle" || ((key.name == "rate" || key.name == "omega") && around.variant == "rotation");
        if (rolling && dim_ == 3 && by_.turns()) no("the axis of a rotating frame is named");
        if (turning && dim_ == 2) x *= by_.handedness();
        if (around.variant == "strain" && key.name == "rate" && by_.axis[0] == 1) x = -x;
        if (around.variant == "taylor_green" && key.name == "speed" && by_.axis[0] == 1) x = -x;
        x *= factor(key, around);
        if (key.name == "level" || (key.name == "height" && around.key == "terrain")) {
            if (!by_.keeps_up()) no("a level lies along y");
            x += by_.shift[1];
        }
        if (tied_to_the_frame.count(key.name) && (by_.turns() || by_.shifts())) no(key.name + " lies in the frame of the domain");
        return x;
    }

    Value numbers(const Key& key, const std::vector<double>& x, const Around& around) {
        if (key.unit.find(',') != std::string::npos) return each_its_own_unit(key, x);
        const double f = extents.count(key.name) && key.type == Type::integers ? 1 : factor(key, around);
        const auto n = static_cast<int>(x.size());
        std::vector<double> out = x;
        if (key.name == "spin" || (key.name == "axis" && key.only_dim == 3)) {
            if (n == 1) return std::vector<double>{f * by_.handedness() * x[0]};
            for (int a = 0; a < n; ++a) out[at(by_.axis[at(a)])] = f * by_.handedness() * by_.sign[at(a)] * x[at(a)];
            return out;
        }
        const bool in_space = (key.length == -1 || key.length == 3) && n == dim_;
        if (!in_space || around.key == "effects.rest_density") {
            if (tied_to_the_frame.count(key.name) && (by_.turns() || by_.shifts())) no(key.name + " lies in the frame of the domain");
            for (double& v : out) v *= f;
            return out;
        }
        for (int a = 0; a < n; ++a) {
            const auto A = at(by_.axis[at(a)]);
            if (places.count(key.name))
                out[A] = by_.sign[at(a)] * f * x[at(a)] + by_.shift[A];
            else if (extents.count(key.name))
                out[A] = f * x[at(a)];
            else if (directions.count(key.name))
                out[A] = by_.sign[at(a)] * f * x[at(a)];
            else
                throw std::logic_error(fmt::format("is {} of {} a place, a direction or an extent?", key.name, around.key));
        }
        return out;
    }

    /// [273.16, 611.657] with the unit "K, Pa".
    Value each_its_own_unit(const Key& key, std::vector<double> x) const {
        std::string_view units = key.unit;
        for (double& v : x) {
            const auto comma = std::min(units.find(','), units.size());
            v *= by_.scale.of(units.substr(0, comma));
            units.remove_prefix(std::min(comma + 1, units.size()));
        }
        return x;
    }

    /// Names of axes: "x", "turning_y".
    Value texts(std::vector<std::string> list) const {
        for (std::string& name : list)
            if (name.size() == 1 || name.starts_with("turning_"))
                if (const char last = name.back(); last >= 'x' && last <= 'z') name.back() = "xyz"[by_.axis[at(last - 'x')]];
        return list;
    }

    Value text(const Key& key, const std::string& text, const Around& around, const Table&) {
        const bool surface = key.name == "surface" && around.key == "initial", height = around.key == "terrain" && key.name == "height";
        if (!surface && !height && !(around.variant == "formula" && key.name == "value")) return text;
        if ((surface || height) && !by_.keeps_up()) no("a height lies along y");
        std::string out = substituted(text);
        const double f = surface || height ? by_.scale.length : factor(key, around);
        if (f != 1) out = fmt::format("{}*({})", scene::number_text(f), out);
        if ((surface || height) && by_.shift[1] != 0) out = fmt::format("{} + ({})", out, scene::number_text(by_.shift[1]));
        return out;
    }

    /// x, y and z of a formula by those of the image: x = sign (X - shift) / length.
    std::string substituted(const std::string& formula) const {
        if (!by_.turns() && !by_.shifts() && by_.scale.length == 1) return formula;
        const auto is_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
        std::string out;
        for (std::size_t i = 0; i < formula.size(); ++i) {
            const char c = formula[i];
            const bool alone = (i == 0 || !is_word(formula[i - 1])) && (i + 1 == formula.size() || !is_word(formula[i + 1]));
            if (c < 'x' || c > 'z' || !alone) {
                out += c;
                continue;
            }
            const auto a = at(c - 'x'), A = at(by_.axis[a]);
            out += fmt::format("(({})*({} - ({})))", scene::number_text(by_.sign[a] / by_.scale.length), "xyz"[A],
                               scene::number_text(by_.shift[A]));
        }
        return out;
    }

    const scene::Scene& scene_;
    int dim_;
    Transformation by_;
    bool moves_domain_;
};

}  // namespace

scene::Scene scene_of_table(const Table& root, const std::string& file) {
    return scene::parse(scene::to_scene_text(root), file, sim::schemas());
}

Table transformed_table(const scene::Scene& read, const Transformation& by, bool moves_domain) {
    return Rewriter(read, by, moves_domain).root();
}

scene::Scene transformed(const scene::Scene& read, const Transformation& by, bool moves_domain) {
    return scene_of_table(transformed_table(read, by, moves_domain), read.file());
}

}  // namespace weir::metamorphic
