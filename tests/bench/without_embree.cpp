#include "embree_only.h"
#include "plain_fcl.h"

#include <stdexcept>

// This file replaces plain_fcl.cpp and embree_only.cpp if Embree is not installed. The benchmark then leaves the
// alternatives (b) and (d) out.
namespace bench {
namespace {

[[noreturn]] void fail()
{
    throw std::logic_error("this build has no plain FCL and no EmbreeOnly, because Embree is not installed");
}

}  // namespace

struct PlainFcl::Impl {};

bool PlainFcl::is_available() { return false; }
PlainFcl::PlainFcl(const spawnfield::Scene&, const spawnfield::Robot&) { fail(); }
PlainFcl::~PlainFcl() = default;
TopRaster PlainFcl::raster_top(const spawnfield::RasterGrid&, double, int) const { fail(); }
spawnfield::VerdictCounts PlainFcl::raster_3d(const spawnfield::RasterGrid&, double, bool, int) const { fail(); }
std::vector<spawnfield::Verdict> PlainFcl::check(const std::vector<spawnfield::Pose>&, double, int) const { fail(); }
bool PlainFcl::is_inside(const spawnfield::Vec3&) const { fail(); }

struct EmbreeOnly::Impl {};

bool EmbreeOnly::is_available() { return false; }
EmbreeOnly::EmbreeOnly(TriangleScene, const spawnfield::Robot&, Use) { fail(); }
EmbreeOnly::~EmbreeOnly() = default;
TopRaster EmbreeOnly::raster_top(const spawnfield::RasterGrid&, double, int, Search) const { fail(); }

}  // namespace bench
