// A scene seen from another place, in a mirror, along other axes or in other units: the same physics in another description. Metamorphic
// testing (Chen, Cheung & Yiu 1998) runs both and compares, so that no right answer has to be known.
#pragma once
#include "metamorphic/units.hpp"
#include "scene/scene.hpp"

#include <array>
#include <stdexcept>
#include <string>

namespace weir::metamorphic {

/// x'[axis[a]] = sign[a] length x[a] + shift[axis[a]].
struct Transformation {
    std::array<int, 3> axis{0, 1, 2};
    std::array<int, 3> sign{1, 1, 1};
    std::array<double, 3> shift{0, 0, 0};  // [m], in the new frame and units
    UnitScale scale{};

    static Transformation mirror(int a);
    static Transformation exchange(int a, int b);
    static Transformation cycle();  // x to y to z to x
    bool turns() const;             // any axis goes elsewhere or backwards
    bool shifts() const { return shift != std::array<double, 3>{0, 0, 0}; }
    bool keeps_up() const { return axis[1] == 1 && sign[1] == 1; }
    bool keeps(int a) const { return axis[a] == a && sign[a] == 1; }
    int handedness() const;  // -1: a mirror image, in which angles count the other way round
};

/// What of a scene has no image under a transformation, and why.
struct Untransformable : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The scene's image. `read` has to know which of its defaults were read (Table::was_read): those are said in the image, because they may
/// have to change as well. `moves_domain` false: grid and sides stay where they are. Throws Untransformable.
scene::Scene transformed(const scene::Scene& read, const Transformation& by, bool moves_domain = true);
/// The same, unchecked: parts of it may lie outside the domain.
scene::Table transformed_table(const scene::Scene& read, const Transformation& by, bool moves_domain);

/// The scene of a table, as text and read again.
scene::Scene scene_of_table(const scene::Table& root, const std::string& file);

}  // namespace weir::metamorphic
