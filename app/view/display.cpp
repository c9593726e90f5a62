#include "app/view/display.hpp"

#include "core/error.hpp"

#include <cstdlib>
#include <string>

#include <X11/Xlib.h>  // in a file of its own: its macros have common names

namespace weir::view {

void need_display(const std::string& program) {
    if (Display* display = XOpenDisplay(nullptr)) {
        XCloseDisplay(display);
        return;
    }
    const char* name = std::getenv("DISPLAY");
    throw BadInput("no display to draw on: DISPLAY is " + (name && *name ? '"' + std::string(name) + '"' : "not set") +
                   "; on a machine without a screen: xvfb-run -a " + program + " ... (Debian: apt-get install xvfb xauth)");
}

}  // namespace weir::view
