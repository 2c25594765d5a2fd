#pragma once

#include <spawnfield/export.h>

#include <stdexcept>
#include <string>

namespace spawnfield {

/// A value that a caller passed is outside its limits. what() names function, argument, value and limit.
class SPAWNFIELD_API ArgumentError : public std::invalid_argument {
public:
    using std::invalid_argument::invalid_argument;
    ArgumentError(const std::string& function, const std::string& message);
    ArgumentError(const std::string& function, const std::string& argument, double value, const std::string& limit);

    /// what() without the function, for users of a program, who call none.
    const char* message() const { return what() + prefix_length_; }

private:
    std::size_t prefix_length_ = 0;
};

/// An input file is missing, malformed or refused. what() names file, place, value and limit.
class SPAWNFIELD_API FileError : public std::runtime_error {
public:
    FileError(const std::string& file, const std::string& message) : std::runtime_error(file + ": " + message) {}
};

/// A result could not be written: no space, no permission.
class SPAWNFIELD_API OutputError : public std::runtime_error {
public:
    OutputError(const std::string& file, const std::string& message) : std::runtime_error(file + ": " + message) {}
};

}  // namespace spawnfield
