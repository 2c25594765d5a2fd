#pragma once

#include <spawnfield/floors.h>
#include <spawnfield/pair_files.h>
#include <spawnfield/poses.h>
#include <spawnfield/query.h>
#include <spawnfield/reach.h>

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The review page: one HTML file that shows a world, where a robot can stand in it, and why not elsewhere. Its format
/// is that of docs/review-format.md.
namespace spawnfield {

/// Poses of a file.
struct ReviewSpawns {
    std::string file;  ///< name of the file, for the user
    PoseTable table;
};

/// Pairs of a file, and the options by which they are judged.
struct ReviewPairs {
    std::string file;
    PairTable table;
    PairOptions options = {};
};

/// What a page shows besides the world and the robot.
struct ReviewContents {
    std::string title = {};    ///< empty: the names of the map and the robot
    std::string command = {};  ///< the command line that makes the page
    /// What the colours of the layer show when the page is opened: verdict, height, island, or a quantity's name.
    std::string colors = "verdict";
    /// 2D rasters of one stance, one for each yaw. All of their poses are judged again, as Judge::check() or settle()
    /// does, with the heights that the page has: multiples of 1e-6 m. In updates,
    /// only those are judged again whose verdict may differ from that of the raster.
    std::vector<RasterResult> rasters = {};
    std::vector<PlaceQuantity> quantities =
        {};                                ///< besides tilt and margin of settled poses: what is measured of poses
    PlaceMeasures measures = {};           ///< settings of these quantities
    std::optional<ReachGraph> graph = {};  ///< of the judge; if it is given, poses have islands. Pairs need it
    std::vector<Floor> floors = {};
    Stance stance = Stance::Settled;  ///< how the robots of `spawns` stand
    std::vector<ReviewSpawns> spawns = {};
    std::vector<ReviewPairs> pairs = {};  ///< the graph must keep its ways
    /// Only the layers, spawns and pairs, for a page that is open already. Its poses have the same verdicts, but
    /// neither reasons nor what they meet.
    bool is_update = false;
    std::string live = {};                 ///< JSON object for the key `live`; empty: the page is not served
    std::size_t most_triangles = 1000000;  ///< a world with more is simplified; > 0
};

/// Limits of a page: the poses of a layer, and those of a list. Browsers cannot show more.
inline constexpr std::size_t most_layer_poses = 16000000, most_list_poses = 100000;

/// Returns whether this library was built with the page, which tools/build-web.sh makes.
SPAWNFIELD_API bool has_review_page();
/// Throws std::runtime_error, which says what to do, unless it was.
SPAWNFIELD_API void require_review_page();

/// Writes a page. Passes the HTML to `sink` in pieces. The result is the same for any number of threads. Throws
/// std::runtime_error unless has_review_page(), ArgumentError for rasters with three dimensions or several headings,
/// for contents that do not go together and for too many poses, FileError for a damaged map, and what options.progress
/// throws.
SPAWNFIELD_API void write_review(const Judge& judge, const ReviewContents& contents,
                                 const std::function<void(std::string_view)>& sink, const RunOptions& options = {});

/// Returns the data of a page, without the page itself: a pack.
SPAWNFIELD_API std::string review_pack(const Judge& judge, const ReviewContents& contents,
                                       const RunOptions& options = {});

}  // namespace spawnfield
