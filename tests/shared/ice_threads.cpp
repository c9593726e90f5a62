// The bodies shared by all backends, on threads with the best instruction set of this processor.
#include "shared/on_threads.hpp"
// first: what the bodies run on
#include "shared/ice_bodies.hpp"
