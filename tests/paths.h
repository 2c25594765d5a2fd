#pragma once

#include <string>

/// Absolute paths, known to paths.cpp alone, so that a checkout elsewhere compiles the other test files to the same
/// objects.
const std::string& source_folder();  ///< of this repository
const std::string& program_file();   ///< the program spawnfield of this build
const std::string& python_file();    ///< a Python that may have the packages of tests/requirements.txt
