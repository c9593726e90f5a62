// What a scene needs of a device's memory, known before any of it is taken: arrays by their bytes a particle.
#pragma once
#include "backend/device.hpp"

#include <string>
#include <vector>

namespace weir::particles {

class DevicePlan {
public:
    /// `memory` shall hold this many bytes for each particle.
    void want(backend::Memory& memory, std::size_t bytes_per_particle) { wanted_.push_back({&memory, bytes_per_particle}); }
    std::size_t bytes_per_particle() const;
    /// Throws BadInput, with the number that would fit, where the device has no room for `count` particles.
    void check(const backend::DeviceInfo& device, std::size_t count) const;
    /// Takes all that is wanted.
    void allocate(backend::Device& device, std::size_t count) const;

private:
    struct Wanted {
        backend::Memory* memory;
        std::size_t bytes;
    };
    std::vector<Wanted> wanted_;
};

}  // namespace weir::particles
