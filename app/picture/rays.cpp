#include "app/picture/rays.hpp"

#include "core/error.hpp"

#ifdef WEIR_HAS_EMBREE
#include <embree3/rtcore.h>
#endif

namespace weir::picture {

Vec<3> MeshRays::flat_normal(const Hit& hit) const {
    const auto& c = mesh_.corners[static_cast<std::size_t>(hit.triangle)];
    const Vec<3>& p = mesh_.points[static_cast<std::size_t>(c[0])];
    const Vec<3> a = mesh_.points[static_cast<std::size_t>(c[1])] - p, b = mesh_.points[static_cast<std::size_t>(c[2])] - p;
    const Vec<3> n{{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
    return n / norm(n);
}

#ifdef WEIR_HAS_EMBREE

bool can_trace_meshes() { return true; }

struct MeshRays::Tree {
    RTCDevice device = rtcNewDevice("threads=1");
    RTCScene scene = rtcNewScene(device);
    ~Tree() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
};

MeshRays::MeshRays(const SurfaceMesh& mesh) : mesh_(mesh), tree_(std::make_unique<Tree>()) {
    rtcSetSceneFlags(tree_->scene, RTC_SCENE_FLAG_ROBUST);  // no ray slips through between two triangles
    const RTCGeometry geometry = rtcNewGeometry(tree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.points.size()));
    for (const Vec<3>& x : mesh.points)
        for (int a = 0; a < 3; ++a) *points++ = static_cast<float>(x[a]);
    auto* corners = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), mesh.corners.size()));
    for (const auto& t : mesh.corners)
        for (const int c : t) *corners++ = static_cast<unsigned>(c);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(tree_->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(tree_->scene);
}

MeshRays::Hit MeshRays::first(const Ray& ray, real from) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray.org_x = static_cast<float>(ray.origin[0]), query.ray.dir_x = static_cast<float>(ray.direction[0]);
    query.ray.org_y = static_cast<float>(ray.origin[1]), query.ray.dir_y = static_cast<float>(ray.direction[1]);
    query.ray.org_z = static_cast<float>(ray.origin[2]), query.ray.dir_z = static_cast<float>(ray.direction[2]);
    query.ray.tnear = static_cast<float>(from);
    query.ray.tfar = std::numeric_limits<float>::infinity();
    query.ray.mask = ~0U;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(tree_->scene, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {query.ray.tfar, static_cast<int>(query.hit.primID), query.hit.u, query.hit.v};
}

#else

bool can_trace_meshes() { return false; }
struct MeshRays::Tree {};
MeshRays::MeshRays(const SurfaceMesh& mesh) : mesh_(mesh) {
    throw BadInput("this weir was built without Embree, which ray tracing of water requires: install libembree-dev and configure again");
}
MeshRays::Hit MeshRays::first(const Ray&, real) const { return {}; }

#endif

MeshRays::~MeshRays() = default;

}  // namespace weir::picture
