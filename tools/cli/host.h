#pragma once

#include <spawnfield/reader_process.h>
#include <spawnfield/types.h>

#include <any>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace spawnfield::cli {

/// The user stopped the command; nothing was written.
struct Interrupted {};

/// What surrounds a command: the program with its terminal, or an interpreter that calls the command.
class Host {
public:
    virtual ~Host() = default;

    virtual void notice(const std::string& text) = 0;
    /// Says why the exit status is not 0.
    virtual void complain(const std::string& message) = 0;
    /// Returns a callback that shows how much of some work is done. It may be empty.
    virtual Progress show_progress(const std::string& label) = 0;
    virtual void hide_progress() = 0;

    /// Any thread may ask.
    virtual bool is_interrupted() const = 0;
    /// Ends an interruption that a command has dealt with; the next one is noticed again.
    virtual void forget_interruption() = 0;

    /// Returns whether results that go to standard output are wanted as text.
    virtual bool wants_text() const = 0;
    /// Returns whether commands must leave what they find in `result`, for which they hold all of it in memory.
    virtual bool wants_values() const = 0;
    /// Writes to standard output. Throws OutputError.
    virtual void write(std::string_view text) = 0;
    virtual void flush() = 0;
    /// Takes the summary of a command: a line for people, and JSON. `is_quiet`: --quiet was given.
    virtual void summarize(const std::string& line, const std::string& json, bool is_quiet) = 0;

    /// Reads scenes and robots for commands without --trusted. Nothing: they are read in this process.
    std::optional<ReaderProcess> reader;
    /// Files that it read for a scene or a robot from outside of the folder of that scene or robot, without links.
    std::set<std::string> outside_files;

    /// Whether `review` must leave an update of its page in `result`, because the page is open already: only layers, or
    /// only the poses of --spawns.
    bool wants_update = false;

    /// Things in memory that the caller gave in place of files. Their names stand where those of files would. A value
    /// is a std::shared_ptr<const T>, where T is Map, Robot, Scene or PoseTable.
    std::map<std::string, std::any> inputs;
    /// What the command found: see results.h. Empty if it only writes files.
    std::any result;

    /// Returns a thing in memory, or nullptr if the name is that of a file.
    template <class T>
    const T* input(const std::string& name) const
    {
        const auto found = inputs.find(name);
        const auto* const held = found == inputs.end() ? nullptr
                                                       : std::any_cast<std::shared_ptr<const T>>(&found->second);
        return held == nullptr ? nullptr : held->get();
    }
};

/// A host without a terminal: what a command finds remains in `result`, and what it says is lost.
class SilentHost : public Host {
public:
    void notice(const std::string&) override {}
    void complain(const std::string&) override {}
    Progress show_progress(const std::string&) override { return {}; }
    void hide_progress() override {}
    bool is_interrupted() const override { return false; }
    void forget_interruption() override {}
    bool wants_text() const override { return false; }
    bool wants_values() const override { return true; }
    void write(std::string_view) override {}
    void flush() override {}
    void summarize(const std::string&, const std::string&, bool) override {}
};

}  // namespace spawnfield::cli
