// VTK without its messages, while it lives.
#pragma once

namespace weir::output {

/// VTK prints what it cannot decompress; the message that names the file is ours.
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
