// Scope in which VTK prints no messages.
#pragma once

namespace weir::output {

/// VTK prints decompression errors; weir's own message names the file.
class SilentVtk {
public:
    SilentVtk();
    ~SilentVtk();
    SilentVtk(const SilentVtk&) = delete;
    SilentVtk& operator=(const SilentVtk&) = delete;

private:
    int before_;
};

}  // namespace weir::output
