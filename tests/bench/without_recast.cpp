#include "nav_mesh.h"

#include <stdexcept>

// Where Recast is not installed: the benchmark leaves alternative (c) out.
namespace bench {
namespace {

[[noreturn]] void fail() { throw std::logic_error("Recast was left out of this build"); }

}  // namespace

struct NavMesh::Impl {};

bool NavMesh::is_available() { return false; }
NavMesh::NavMesh(const spawnfield::Scene&, const Walker&) { fail(); }
NavMesh::~NavMesh() = default;
std::vector<spawnfield::Vec3> NavMesh::draw(std::size_t, std::uint64_t) const { fail(); }
bool NavMesh::covers(const spawnfield::Vec3&) const { fail(); }
int NavMesh::tiles() const { fail(); }
int NavMesh::polygons() const { fail(); }

}  // namespace bench
