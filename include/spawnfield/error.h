#pragma once

#include <spawnfield/export.h>

#include <stdexcept>
#include <string>

namespace spawnfield {

/// A value from a caller is outside its limits. what() names the function, the argument, the value and the limit.
class SPAWNFIELD_API ArgumentError : public std::invalid_argument {
public:
    using std::invalid_argument::invalid_argument;
    ArgumentError(const std::string& function, const std::string& message);
    ArgumentError(const std::string& function, const std::string& argument, double value, const std::string& limit);

    /// Returns what() without the name of the function, for users of a program: they do not call functions.
    const char* message() const { return what() + prefix_length_; }

private:
    std::size_t prefix_length_ = 0;
};

/// An input file is missing, malformed or refused. what() names the file, the place, the value and the limit.
class SPAWNFIELD_API FileError : public std::runtime_error {
public:
    FileError(const std::string& file, const std::string& message) : std::runtime_error(file + ": " + message) {}
};

/// A result could not be written, for example because the disk is full or permission is missing.
class SPAWNFIELD_API OutputError : public std::runtime_error {
public:
    OutputError(const std::string& file, const std::string& message) : std::runtime_error(file + ": " + message) {}
};

}  // namespace spawnfield
