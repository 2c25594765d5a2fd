#pragma once

#include <string>

/// What differs between builds. Only this_build.cpp contains it, so that the other test files compile to the same
/// objects in every checkout, with and without a sanitizer.

bool is_slow_build();                ///< without optimisation, or with a sanitizer: some tests are shorter then
const std::string& source_folder();  ///< root folder of this repository
const std::string& program_file();   ///< the program spawnfield of this build
const std::string& python_file();    ///< a Python that may have the packages of tests/requirements.txt
