#pragma once

#include <string>

/// Absolute paths. Only paths.cpp contains them, so that the other test files compile to the same objects in every
/// checkout.
const std::string& source_folder();  ///< root folder of this repository
const std::string& program_file();   ///< the program spawnfield of this build
const std::string& python_file();    ///< a Python that may have the packages of tests/requirements.txt
