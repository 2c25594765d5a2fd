#include "apart/scene_fields.h"
#include "base/geo_tags.h"
#include "base/png.h"
#include "base/tiff.h"
#include "../../mesh_text.h"
#include "reader.h"

#include <spawnfield/input_file.h>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <octomap/OcTree.h>

#include <algorithm>
#include <cstring>
#include <sstream>
#include <stdexcept>

namespace fuzz {
namespace {

namespace fs = std::filesystem;
using namespace spawnfield;

/// Collects seeds.
class Collector {
public:
    explicit Collector(const std::vector<Reader>& readers) : readers_(readers) {}

    void add(const std::string& reader, const std::string& ending, std::string_view bytes)
    {
        const auto found = std::find_if(readers_.begin(), readers_.end(),
                                        [&](const Reader& known) { return known.name == reader; });
        if (found == readers_.end()) throw std::out_of_range("there is no reader " + reader);
        seeds_.push_back(
            {reader, reader + ending + " " + std::to_string(seeds_.size()), input_of(*found, ending, bytes)});
    }
    /// Adds a mesh for our own readers and checks, and for assimp.
    void add_mesh(const std::string& ending, std::string_view bytes)
    {
        add("meshes", ending, bytes);
        if (ending != ".ply" && ending != ".amf") add("apart_meshes", ending, bytes);
    }
    std::vector<Seed> take() { return std::move(seeds_); }

private:
    const std::vector<Reader>& readers_;
    std::vector<Seed> seeds_;
};

template <class T>
std::string archived(T value)
{
    ArchiveWriter out;
    out(value);
    return out.take();
}

void add_tables(Collector& out, const fs::path& source)
{
    out.add("poses", ".csv", read_file(source / "tests/data/maps/poses.csv"));
    out.add("poses", ".csv",
            "name,x,y,z,qx,qy,qz,qw,verdict\n\"a, b\",1,2.5,0,0,0,0.6,0.8,valid\n,-1e3,0,0,0,0,0,1,steep\n");
    out.add("poses", ".csv", "x,y,z,roll_deg,pitch_deg,yaw_deg\r\n1,2,3,4,5,6\r\n");
    out.add(
        "poses", ".csv",
        "{\"format\": \"spawnfield-spawns/1\", \"poses\": [{\"name\": \"a\", \"kind\": \"k\", \"verdict\": \"valid\", "
        "\"position\": [1, 2.5, 0], \"rpy\": [0, 0, 1.57]}]}");
    out.add("poses", ".csv",
            "{\"format\": \"spawnfield-fleet-poses/1\", \"robots\": [{\"position\": [1, 2, 3], \"rpy\": [0, 0, 0]}]}");
    out.add("poses", ".pairs",
            "start_x,start_y,start_z,start_yaw,goal_x,goal_y,goal_z,goal_yaw,path_length\n1,2,3,0.5,4,5,6,-1,9.5\n");
    out.add(
        "regions", ".geojson",
        "{\"type\": \"FeatureCollection\", \"features\": [{\"type\": \"Feature\", \"geometry\": {\"type\": "
        "\"Polygon\", \"coordinates\": [[[0, 0], [4, 0], [4, 3], [0, 0]], [[1, 1], [2, 1], [1.5, 1.5], [1, 1]]]}}]}");
    out.add(
        "regions", ".geojson",
        "{\"type\": \"GeometryCollection\", \"geometries\": [{\"type\": \"MultiPolygon\", \"coordinates\": [[[[0, 0], "
        "[4, 0], [4, 3], [0, 0]]]]}]}");
    out.add("regions", ".csv", "x,y,polygon\n0,0,a\n4,0,a\n4,3,a\n7,7,b\n8,7,b\n8,8,b\n");
    out.add("regions", ".csv", "x,y\n0,0\n4,0\n4,3\n\n7,7\n8,7\n8,8\n");
}

void add_settings(Collector& out, const fs::path& source)
{
    out.add("settings", ".fleet", read_file(source / "maps/training/fleet.yaml"));
    out.add(
        "settings", ".fleet",
        "format: spawnfield-fleet/1\nformation: {shape: line, spacing: 2}\nrobots:\n- {name: a, robot: r.yaml, count: "
        "2, max_step: 0.1, max_slope: 20, z: \"0,1\", layers: top, drive: car, floor: 1, keep_out: a.csv}\n");
    out.add(
        "settings", ".rules",
        "min_free_area: 100\nmax_islands: 20\nmax_closed_rooms: 0\nmax_floating: 0\nmax_sunken: 0\nmax_overlaps: 3\n"
        "max_missing: 0\nrequire: [dock, [1, 2, 0.1, 1.57]]\nallow: [\"lamp*\", flag]\n");
    for (const char* const robot : {"car.yaml", "husky.yaml", "husky_wheels.yaml"})
        out.add("robots", ".yaml", read_file(source / "maps/robots" / robot));
    out.add("robots", ".yaml",
            "format: spawnfield-robot/1\nname: r\nparts:\n- {mesh: wedge.obj, scale: [1, 2, 3], rpy_deg: [0, 0, 30]}\n"
            "- {sphere: 0.2, xyz: [0, 0, 1]}\n- {capsule: {radius: 0.1, length: 1}}\nmass_center: [0, 0, 0.1]\n"
            "drive: legged\nmax_step: 0.2\n");
    for (const char* const robot : {"cart.urdf", "rover.urdf"})
        out.add("robots", ".urdf", read_file(source / "maps/robots" / robot));
    out.add("robots", ".urdf",
            "<robot name=\"r\"><link name=\"a\"><inertial><origin xyz=\"0 0 1\"/><mass value=\"3\"/><inertia ixx=\"1\" "
            "ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial><collision><geometry><mesh "
            "filename=\"wedge.obj\" scale=\"1 1 2\"/></geometry></collision></link></robot>");
    // Small, so that the fuzzer often exchanges the names of links.
    out.add("robots", ".urdf",
            "<robot name=\"r\"><link name=\"a\"><collision><geometry><sphere radius=\"1\"/></geometry></collision>"
            "</link><link name=\"b\"/><link name=\"c\"/>"
            "<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint>"
            "<joint name=\"k\" type=\"continuous\"><parent link=\"b\"/><child link=\"c\"/></joint></robot>");
}

void add_scenes(Collector& out, const fs::path& source)
{
    for (const char* const scene : {"maps/storeys/scene.yaml", "maps/training/scene.yaml"})
        out.add("scenes", ".yaml", read_file(source / scene));
    out.add("scenes", ".yaml",
            "format: spawnfield-scene/1\nname: town\nparts:\n"
            "- {name: floor, label: terrain, box: [20, 20, 0.1], xyz: [0, 0, -0.05], rpy: [0, 0, 0]}\n"
            "- {name: mast, cylinder: {radius: 0.1, length: 4}}\n- {name: tank, capsule: {radius: 1, length: 4}}\n"
            "- {name: lake, label: water, plane: [5, 5], xyz: [7, 7, 1.4]}\n"
            "- name: house\n  mesh: wedge.ply\n  up: y\n  scale: [1, 2, 3]\n  solid: true\n  sides: up\n  labels:\n"
            "  - {node: \"road*\", label: terrain}\n  - {material: \"*water*\", label: water}\n"
            "- {name: relief, label: terrain, heightmap: {file: grid.asc, size: [13, 13]}}\n"
            "- name: forklift\n  box: [2, 1, 2]\n"
            "  path: [{time: 0, xyz: [0, 5, 1]}, {time: 8, xyz: [6, 5, 1]}, {time: 10, xyz: [6, 5, 1], rpy_deg: [0, 0, "
            "90]}]\n");
    out.add(
        "scenes", ".yaml",
        "format: spawnfield-scene/1\nparts: [{name: a, mesh: wedge.ply, auto_label: {slope: 30}}, {name: s, sphere: "
        "1}]\n");
    out.add("scenes", ".urdf", read_file(source / "maps/robots/cart.urdf"));
    const std::string yard = read_file(source / "maps/yard/yard.sdf");
    const std::string model =
        "<?xml version='1.0'?><sdf version='1.7'><model name='m'><pose>1 2 3 0 0 0.5</pose><link name='l'><collision "
        "name='c'><pose relative_to='__model__'>0 0 1 0 0 0</pose><geometry><sphere><radius>2</radius></sphere>"
        "</geometry></collision></link><joint name='j' type='revolute'><parent>world</parent><child>l</child><axis>"
        "<xyz>0 0 1</xyz></axis></joint></model></sdf>";
    const std::string included =
        "<?xml version='1.0'?><sdf version='1.6'><world name='w'><include><uri>model://ground_plane</uri></include>"
        "<model name='a'><link name='l'><collision name='c'><geometry><box><size>1 2 3</size></box></geometry>"
        "</collision></link></model></world></sdf>";
    for (const std::string& text : {yard, model, included}) {
        out.add("sdf_text", ".sdf", text);
        out.add("apart_sdf", ".sdf", text);
    }
}

/// Returns the bytes of a GeoTIFF of 3 x 3 floats, in strips or in a tile.
std::string geo_tiff(const TempFolder& folder, bool is_tiled)
{
    const fs::path file = folder / "a.tif";
    fs::remove(file);
    {
        const Tiff tiff = open_tiff(file, "w");
        for (const auto& [tag, value] :
             {std::pair{TIFFTAG_IMAGEWIDTH, 3},
              {TIFFTAG_IMAGELENGTH, 3},
              {TIFFTAG_BITSPERSAMPLE, 32},
              {TIFFTAG_SAMPLESPERPIXEL, 1},
              {TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP},
              {TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK},
              {TIFFTAG_COMPRESSION, is_tiled ? COMPRESSION_ADOBE_DEFLATE : COMPRESSION_NONE}})
            TIFFSetField(tiff.get(), std::uint32_t(tag), value);
        const double scale[3]{2, 2, 0}, tie[6]{0, 0, 0, 500000, 4000000, 0};
        const std::uint16_t keys[16]{1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 32611};
        TIFFSetField(tiff.get(), model_pixel_scale, 3, scale);
        TIFFSetField(tiff.get(), model_tiepoint, 6, tie);
        TIFFSetField(tiff.get(), geo_key_directory, 16, keys);
        TIFFSetField(tiff.get(), gdal_no_data, "-9999");
        std::vector<float> pixels(is_tiled ? 256 : 9, 1.5f);
        if (is_tiled) {
            TIFFSetField(tiff.get(), TIFFTAG_TILEWIDTH, 16);
            TIFFSetField(tiff.get(), TIFFTAG_TILELENGTH, 16);
            TIFFWriteEncodedTile(tiff.get(), 0, pixels.data(), tmsize_t(pixels.size() * sizeof(float)));
        } else {
            TIFFSetField(tiff.get(), TIFFTAG_ROWSPERSTRIP, 3);
            TIFFWriteEncodedStrip(tiff.get(), 0, pixels.data(), tmsize_t(pixels.size() * sizeof(float)));
        }
    }
    return read_file(file);
}

void add_grids(Collector& out, const TempFolder& folder)
{
    out.add("grids", ".asc",
            "ncols 3\nnrows 2\nxllcorner 500000\nyllcorner 4000000\ncellsize 2\nNODATA_value -9999\n"
            "1 2 3\n4 -9999 6\n");
    out.add("grids", ".asc", "NROWS 1\nNCOLS 2\nXLLCENTER 0\nYLLCENTER 0\nDX 1\nDY 2\n1.5e1 -2\n");
    out.add("grids", ".pgm", "P2\n# a comment\n3 2 255\n0 100 254\n255 205 7\n");
    out.add("grids", ".pgm", std::string("P5 3 2 300\n") + std::string(12, '\1'));
    const std::vector<std::uint16_t> grey{1, 2, 3, 4, 5, 65535};
    write_grey_png(folder / "grey.png", 2, 3, grey.data());
    const std::vector<std::uint8_t> colours(18, 7);
    const std::string grey_png = read_file(folder / "grey.png"), colour_png = bgr_png("a", 2, 3, colours.data());
    for (const std::string& png : {grey_png, colour_png}) {
        out.add("grids", ".png", png);
        out.add("grids", ".colour", png);
    }
    out.add("grids", ".raw", std::string(60, '\0'));
    out.add("grids", ".yaml",
            "image: grey.pgm\nresolution: 0.05\norigin: [-1, -2, 0.5]\nnegate: 0\noccupied_thresh: "
            "0.65\nfree_thresh: 0.196\nmode: trinary\n");
    out.add("grids", ".yaml",
            "image: grey.pgm\nresolution: 1\norigin: [0, 0, 0]\nnegate: 1\noccupied_thresh: 0.65\n"
            "free_thresh: 0.196\nmode: scale\n");
    for (const bool is_tiled : {false, true}) out.add("apart_tiff", ".tif", geo_tiff(folder, is_tiled));
}

/// Returns a binary glTF with the JSON and without buffers.
std::string glb(std::string json)
{
    while (json.size() % 4 != 0) json += ' ';
    BinaryWriter out;
    for (const std::uint64_t number :
         {std::uint64_t(0x46546C67), std::uint64_t(2), json.size() + 20, json.size(), std::uint64_t(0x4E4F534A)})
        out.put(std::uint32_t(number));
    return out.take() + json;
}

void add_meshes(Collector& out, const TempFolder& folder)
{
    const hand::Mesh box = hand::box({1, 2, 3});
    const std::string obj = mesh_text::obj(box), json = mesh_text::gltf({{.mesh = box}});
    out.add_mesh(".obj", obj);
    out.add_mesh(".obj",
                 "mtllib a.mtl\no a\n v .5 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\ng b c\nusemtl m\nf 1//1 2//1 3//1\n");
    out.add_mesh(".dae", mesh_text::dae({{.mesh = box}}));
    out.add_mesh(".gltf", json);
    out.add("meshes", ".glb", glb(json));
    out.add_mesh(".3mf", mesh_text::package_3mf("unit=\"inch\""));
    out.add_mesh(".3mf", mesh_text::package_3mf(
                             "", mesh_text::wedge_3mf +
                                     "<object id=\"2\"><components><component objectid=\"1\"/></components></object>"));
    out.add_mesh(".amf", "<?xml version=\"1.0\"?><amf unit=\"inch\"><object id=\"0\"/></amf>");
    const std::string head =
        " 1.0\ncomment a\nelement vertex 3\nproperty float x\nproperty float y\nproperty double z\n"
        "property uchar red\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    out.add_mesh(".ply", "ply\nformat ascii" + head + "0 0 0 7\n1 0 0 7\n0 1 0 7\n3 0 1 2\n");
    out.add_mesh(".ply",
                 "ply\nformat binary_little_endian" + head + std::string(51, '\0') + '\3' + std::string(12, '\0'));
    out.add_mesh(".ply",
                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                 "element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
                 "4 0 1 2 -1\n");
    out.add("apart_meshes", ".stl", mesh_text::stl(box));
    out.add("apart_meshes", ".off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n");
    Assimp::Importer importer;
    const aiScene* const scene = importer.ReadFile(folder.write("box.obj", obj).string(), 0);
    using Format = std::pair<const char*, const char*>;
    for (const auto& [format, ending] :
         {Format{"stlb", ".stl"}, Format{"3ds", ".3ds"}, Format{"glb2", ".glb"}, Format{"fbxa", ".fbx"}}) {
        const fs::path file = folder / (std::string("box") + ending);
        if (Assimp::Exporter().Export(scene, format, file.string()) != AI_SUCCESS)
            throw std::runtime_error(std::string("assimp cannot write ") + format);
        out.add("apart_meshes", ending, read_file(file));
    }
}

void add_octomaps(Collector& out)
{
    octomap::OcTree tree(0.25);
    for (int k = 0; k < 60; ++k)
        tree.updateNode(octomap::point3d(0.25f * float(k % 5), 0.25f * float(k % 4), 0.25f * float(k % 3)), k % 7 != 0);
    std::ostringstream full, binary;
    tree.write(full);
    tree.writeBinary(binary);
    out.add("apart_octomaps", ".ot", full.str());
    out.add("apart_octomaps", ".bt", binary.str());
}

void add_map_files(Collector& out, const fs::path& source)
{
    const fs::path maps = source / "tests/data/maps";
    for (const char* const version : {"format-3", "format-5", "format-6", "format-7", "format-9"})
        out.add("tiles", ".geometry", read_file(maps / version / "geometry.bin"));
    for (const char* const version : {"format-3", "format-4"})
        out.add("tiles", ".bounds", read_file(maps / version / "bounds.bin"));
    out.add("maps", ".yaml", read_file(maps / "format-9/map.yaml"));
    out.add("maps", ".tiff", read_file(maps / "format-3/terrain.tiff"));
    out.add("maps", ".bt", read_file(maps / "format-3/occupancy.bt"));
    out.add("apart_octomaps", ".bt", read_file(maps / "format-3/occupancy.bt"));
    out.add("graphs", ".bin", graph_bytes(source));
}

void add_archives(Collector& out, const TempFolder& folder)
{
    folder.write("box.obj", mesh_text::obj(hand::box({1, 1, 1})));
    const Scene scene = load_scene(folder.write(
        "scene.yaml",
        "format: spawnfield-scene/1\nparts: [{name: floor, label: terrain, box: [8, 8, 1]}, {name: m, mesh: "
        "box.obj}]\n"));
    out.add("archives", ".scene", archived(scene));
    const Robot robot = load_robot(
        folder.write("robot.yaml", "format: spawnfield-robot/1\nparts: [{box: [1, 1, 1]}, {mesh: box.obj}]\n")
            .string());
    out.add("archives", ".robot", archived(robot));
}

}  // namespace

std::vector<Seed> seeds(const std::vector<Reader>& readers, const fs::path& source)
{
    const TempFolder folder;
    Collector out(readers);
    add_tables(out, source);
    add_settings(out, source);
    add_scenes(out, source);
    add_grids(out, folder);
    add_meshes(out, folder);
    add_octomaps(out);
    add_map_files(out, source);
    add_archives(out, folder);
    return out.take();
}

}  // namespace fuzz
