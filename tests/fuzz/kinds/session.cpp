#include "app/live/session.hpp"
#include "fuzz/read_any.hpp"
#include "fuzz/scratch.hpp"
#include "fuzz/small.hpp"
#include "fuzz/targets.hpp"

/// Two steps of a session that begins with these bytes, its end, and the scene that it kept: that one must be a scene.
bool weir::fuzz::session(std::string_view bytes) {
    std::optional<live::Session> session;
    try {
        const auto scene = live::endless(written("scene.toml", bytes), {});
        require_small(scene);
        session.emplace(scene, scratch_folder() / "out");
        session->step();
        session->step();
    } catch (const BadInput&) {
        return false;
    } catch (const NumericalFailure&) {
        return false;
    }
    (void)scene::read(session->finish(), sim::schemas());
    return true;
}
