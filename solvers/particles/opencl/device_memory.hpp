// Memory estimate of a scene on a device, before anything is allocated: arrays and their bytes per particle.
#pragma once
#include "backend/device.hpp"

#include <string>
#include <vector>

namespace weir::particles {

class DevicePlan {
public:
    /// Plans this many bytes per particle for `memory`.
    void want(backend::Memory& memory, std::size_t bytes_per_particle) { wanted_.push_back({&memory, bytes_per_particle}); }
    std::size_t bytes_per_particle() const;
    /// Throws BadInput, with the number that would fit, where the device has too little memory for `count` particles.
    void check(const backend::DeviceInfo& device, std::size_t count) const;
    /// Allocates all planned arrays.
    void allocate(backend::Device& device, std::size_t count) const;

private:
    struct Wanted {
        backend::Memory* memory;
        std::size_t bytes;
    };
    std::vector<Wanted> wanted_;
};

}  // namespace weir::particles
