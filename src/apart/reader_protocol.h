#pragma once

#include <cstdint>

// The messages between a program and its reader process. The request is: the version of the program, a RequestKind, the
// file or robot as text, the folders of --confine, the limit of memory, and the options. The answer is an AnswerKind
// and what belongs to it. Both are bytes of an Archive in memory files that the process inherits; the answer's file
// begins with a ReaderStatus.
namespace spawnfield {

/// The only argument with which a program becomes a reader process.
inline constexpr const char* reader_argument = "--read-for-parent";

/// Numbers of the inherited memory files.
inline constexpr int request_descriptor = 3, answer_descriptor = 4;

enum class RequestKind : std::uint8_t { Scene, Robot };

enum class AnswerKind : std::uint8_t {
    Result,         ///< a Scene or a Robot follows
    FileError,      ///< its text follows
    ArgumentError,  ///< the name of the function and the text follow
    OutOfMemory,
    Failure  ///< the text of another exception follows
};

}  // namespace spawnfield
