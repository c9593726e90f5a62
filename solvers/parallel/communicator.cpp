#include "parallel/communicator.hpp"

#include <utility>

namespace weir {

namespace {
std::unique_ptr<Communicator>& of_process() {
    static std::unique_ptr<Communicator> several;
    return several;
}
}  // namespace

Communicator& communicator() {
    static Communicator one;
    return of_process() ? *of_process() : one;
}

void set_communicator(std::unique_ptr<Communicator> several) { of_process() = std::move(several); }

OwnPlanes::OwnPlanes(const Cut& cut, int reach, int kept, bool ring) : before_(detail::own_share) {
    if (cut.empty()) return;
    const int rank = communicator().rank();
    detail::own_share = {.begin = rank == 0 ? INT_MIN : cut.begin(rank),
                         .end = rank + 1 == cut.ranks() ? INT_MAX : cut.end(rank, cut.planes()),
                         .cut = &cut,
                         .reach = reach,
                         .kept = kept,
                         .ring = ring};
}

}  // namespace weir
