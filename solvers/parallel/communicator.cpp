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

}  // namespace weir
