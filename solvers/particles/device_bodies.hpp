// Bodies among the particles of a device. The device does what it does beside any solid that moves; what bodies are given is summed on the
// host, by the code of the threads and in their order, so that both end in the same bits. For that some numbers of each particle cross
// once or twice a step, sorted positions in each iteration of PBF, as they do for pieces of ice (device_ice.cpp).
#pragma once
#include "particles/bodies_in_liquid.hpp"
#include "particles/device_fluid.hpp"

#include <vector>

namespace weir::particles {

template <int D>
class BodiesOnDevice {
public:
    BodiesOnDevice(DeviceFluid<D>& fluid, BodiesInLiquid<D>& bodies, const plain::WallParams& walls)
        : fluid_(fluid), bodies_(bodies), walls_(walls) {}
    /// After neighbours are found: which sorted particles can meet a solid in this step.
    void find_near();
    const std::vector<int>& near() const { return near_; }
    /// Whose place is sorted place k.
    const std::vector<int>& owners() const { return owners_; }
    /// Who meets whom at sorted positions (a or b), by the terms written there. Returns the positions, four numbers each.
    std::vector<float>& meet(const backend::Memory& positions);
    /// Sorted positions a of the particles near solids, D numbers each.
    const std::vector<float>& places();
    std::size_t bytes() const {
        return (near_.capacity() + owners_.capacity()) * sizeof(int) + flags_.capacity() +
               (four_.capacity() + terms_.capacity() + places_.capacity()) * sizeof(float);
    }

private:
    DeviceFluid<D>& fluid_;
    BodiesInLiquid<D>& bodies_;
    plain::WallParams walls_;
    std::vector<unsigned char> flags_;
    std::vector<int> near_, owners_;
    std::vector<float> four_, terms_, places_;
};

}  // namespace weir::particles
