#include "nav_mesh.h"

#include <stdexcept>

// This file replaces nav_mesh.cpp if Recast is not installed. The benchmark then leaves alternative (c) out.
namespace bench {
namespace {

[[noreturn]] void fail()
{
    throw std::logic_error("this build has no navigation mesh, because Recast is not installed");
}

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
