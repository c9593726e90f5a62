// Bodies among the particles of a device. The device treats them like any moving solid. The forces on bodies are summed on the host, by the
// code of the threads and in the same order, so that both give the same bits. Some numbers of each particle are therefore transferred once
// or twice per step; in PBF sorted positions are transferred in each iteration, as for pieces of ice (device_ice.cpp).
#pragma once
#include "particles/boundaries/bodies_in_liquid.hpp"
#include "particles/opencl/device_fluid.hpp"

#include <vector>

namespace weir::particles {

template <int D>
class BodiesOnDevice {
public:
    BodiesOnDevice(DeviceFluid<D>& fluid, BodiesInLiquid<D>& bodies, const plain::WallParams& walls)
        : fluid_(fluid), bodies_(bodies), walls_(walls) {}
    /// After the neighbour search: finds the sorted particles that can reach a solid in this step.
    void find_near();
    const std::vector<int>& near() const { return near_; }
    /// Original index of sorted particle k.
    const std::vector<int>& owners() const { return owners_; }
    /// Finds the coupling pairs at sorted positions (a or b), with the terms computed there. Returns the positions, four numbers each.
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
