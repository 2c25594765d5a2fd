#include "robot/hull.h"

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

#include <Eigen/Geometry>

#include <cstdio>
#include <map>
#include <memory>
#include <stdexcept>

namespace spawnfield {
namespace {

using Faces = std::vector<std::array<int, 3>>;

/// One run of qhull. The destructor frees qhull's memory.
class Quickhull {
public:
    explicit Quickhull(const std::vector<Vec3>& points) : sink_(std::fopen("/dev/null", "w"), &std::fclose)
    {
        for (const Vec3& p : points) coordinates_.insert(coordinates_.end(), p.data(), p.data() + 3);
        qh_zero(&qh_, sink_.get());
        char options[] = "qhull Qt Pp";  // Qt: triangulated facets
        failed_ = qh_new_qhull(&qh_, 3, int(points.size()), coordinates_.data(), False, options, nullptr,
                               sink_.get()) != 0;
    }
    Quickhull(const Quickhull&) = delete;
    Quickhull& operator=(const Quickhull&) = delete;
    ~Quickhull()
    {
        int rest = 0, total = 0;
        qh_freeqhull(&qh_, !qh_ALL);
        qh_memfreeshort(&qh_, &rest, &total);
    }

    bool failed() const { return failed_; }

    Faces faces()
    {
        Faces out;
        for (facetT* facet = qh_.facet_list; facet != nullptr && facet->next != nullptr; facet = facet->next) {
            std::array<int, 3> corners{};
            for (int i = 0; i < 3; ++i)
                corners[std::size_t(i)] = qh_pointid(&qh_, static_cast<vertexT*>(facet->vertices->e[i].p)->point);
            out.push_back(corners);
        }
        return out;
    }

private:
    std::unique_ptr<FILE, int (*)(FILE*)> sink_;
    std::vector<double> coordinates_;
    qhT qh_{};
    bool failed_ = true;
};

}  // namespace

RobotPart convex_hull(const std::vector<Vec3>& points)
{
    if (points.size() < 4) throw std::domain_error("fewer than 4 points");
    Quickhull quickhull(points);
    if (quickhull.failed()) throw std::domain_error("its points lie in a plane");
    RobotPart hull;
    hull.shape.kind = ShapeKind::Hull;
    std::map<int, int> index;
    for (auto face : quickhull.faces()) {
        for (int& corner : face) {
            const auto [entry, is_new] = index.try_emplace(corner, int(hull.hull_vertices.size()));
            if (is_new) hull.hull_vertices.push_back(points[std::size_t(corner)]);
            corner = entry->second;
        }
        hull.hull_faces.push_back(face);
    }
    const Vec3 centre = hull.centre();
    for (auto& face : hull.hull_faces) {
        const Vec3 &a = hull.hull_vertices[std::size_t(face[0])], &b = hull.hull_vertices[std::size_t(face[1])],
                   &c = hull.hull_vertices[std::size_t(face[2])];
        if ((b - a).cross(c - a).dot(a - centre) < 0) std::swap(face[1], face[2]);
    }
    return hull;
}

RobotPart grown(const RobotPart& part, double margin)
{
    RobotPart out = part;
    Vec3& size = out.shape.size;
    switch (part.shape.kind) {
    case ShapeKind::Box: size += Vec3::Constant(2 * margin); break;
    case ShapeKind::Sphere:
    case ShapeKind::Capsule: size[0] += margin; break;
    case ShapeKind::Cylinder: size += Vec3(margin, 2 * margin, 0); break;
    case ShapeKind::Hull: {
        std::vector<Vec3> corners;
        for (const Vec3& vertex : part.hull_vertices)
            for (int corner = 0; corner < 8; ++corner)
                corners.push_back(vertex +
                                  margin * Vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1));
        return convex_hull(corners);
    }
    }
    return out;
}

}  // namespace spawnfield
