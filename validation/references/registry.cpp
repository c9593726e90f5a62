// Every reference by name: one line each.
#include "validation/harness/reference.hpp"

// X(taylor_green) X(couette) ...: each is a REFERENCE(name) of this folder.
#define ALL_REFERENCES(X)

#define DECLARE(name) REFERENCE(name);
ALL_REFERENCES(DECLARE)

namespace weir::validation {

#define ENTRY(name) {#name, name##_reference},
const std::vector<ReferenceKind>& references() {
    static const std::vector<ReferenceKind> all = {ALL_REFERENCES(ENTRY)};
    return all;
}

}  // namespace weir::validation
