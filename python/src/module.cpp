#include "bindings.h"
#include "interpreter.h"

#include <spawnfield/error.h>
#include <spawnfield/map.h>
#include <spawnfield/output_file.h>
#include <spawnfield/poses.h>
#include <spawnfield/robot.h>
#include <spawnfield/scene.h>

#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

namespace spawnfield::python {
namespace {

/// Puts an object into the inputs if it is a T.
template <class T>
bool put(cli::Host& host, const std::string& name, nb::handle object)
{
    if (!nb::isinstance<T>(object)) return false;
    host.inputs[name] = std::shared_ptr<const T>(nb::cast<std::shared_ptr<T>>(object));
    return true;
}

nb::dict run(const std::vector<std::string>& words, const nb::dict& inputs, bool wants_text,
             const nb::callable& on_message, const nb::object& on_progress)
{
    Interpreter host;
    for (const auto& [key, object] : inputs) {
        const std::string name = nb::cast<std::string>(key);
        if (!put<Map>(host, name, object) && !put<Robot>(host, name, object) && !put<Scene>(host, name, object) &&
            !put<PoseTable>(host, name, object))
            throw ArgumentError("the input " + name + " is of an unknown type");
    }
    return host.run(words, wants_text, on_message, on_progress);
}

/// Writes a file, completely or not at all.
void write_file(const std::string& file, const nb::bytes& bytes)
{
    const std::string_view view(bytes.c_str(), bytes.size());
    const nb::gil_scoped_release unlocked;
    write_file_atomically(file, view);
}

}  // namespace
}  // namespace spawnfield::python

NB_MODULE(_core, module)
{
    using namespace spawnfield;
    module.doc() = "The commands of spawnfield, for the package `spawnfield`.";
    nanobind::exception<ArgumentError>(module, "ArgumentError", PyExc_ValueError);
    nanobind::exception<FileError>(module, "FileError", PyExc_OSError);
    nanobind::exception<OutputError>(module, "OutputError", PyExc_OSError);
    nanobind::exception<python::NothingFits>(module, "NothingFits", PyExc_ValueError);
    python::bind_scenes(module);
    python::bind_results(module);
    python::bind_options(module);
    module.def("run", &python::run, nanobind::arg("words"), nanobind::arg("inputs"), nanobind::arg("wants_text"),
               nanobind::arg("on_message"), nanobind::arg("on_progress").none());
    module.def("version", &version);
    module.def("write_file", &python::write_file, nanobind::arg("file"), nanobind::arg("bytes"));
}
