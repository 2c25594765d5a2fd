#include "base/csv.h"
#include "base/input_file.h"
#include "base/parallel.h"
#include "poses/json_poses.h"
#include "poses/pose_rows.h"

#include <spawnfield/error.h>
#include <spawnfield/pose_stream.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>
#include <optional>

namespace spawnfield {
namespace {

constexpr std::size_t piece = 1 << 20;         // bytes that are read at once
constexpr std::size_t longest_line = 1 << 20;  // bytes; a longer one is not a row of poses

/// Splits a text into lines.
class Lines {
public:
    Lines(PoseStream::Source source, std::string file) : source_(std::move(source)), file_(std::move(file)) {}

    /// Returns the next line without its end; nothing at the end of the text. Valid until the next call.
    std::optional<std::string_view> next()
    {
        for (;;) {
            const char* const begin = text_.data() + at_;
            const auto* const end = static_cast<const char*>(std::memchr(begin, '\n', text_.size() - at_));
            if (end == nullptr && !has_ended_) {
                read_more();  // moves the text
                continue;
            }
            if (end == nullptr && at_ == text_.size()) return std::nullopt;
            ++number_;
            const std::string_view line(begin, end == nullptr ? text_.size() - at_ : std::size_t(end - begin));
            at_ += line.size() + (end != nullptr);
            return without_marks(line);
        }
    }

    std::uint64_t number() const { return number_; }  ///< of the last line, from 1 on
    std::uint64_t bytes() const { return read_; }     ///< that were read

    /// Returns all text that is left.
    std::string rest()
    {
        while (!has_ended_) read_more(true);
        return text_.substr(std::exchange(at_, text_.size()));
    }

    /// Returns whether the text begins with a brace. Call it first.
    bool is_json() { return read_more() && spawnfield::is_json(text_); }

private:
    std::string_view without_marks(std::string_view line) const
    {
        if (number_ == 1 && line.starts_with(byte_order_mark)) line.remove_prefix(byte_order_mark.size());
        if (line.ends_with('\r')) line.remove_suffix(1);
        return line;
    }

    /// Returns false at the end of the text.
    bool read_more(bool any_length = false)
    {
        if (has_ended_) return false;
        text_.erase(0, std::exchange(at_, 0));
        const std::size_t old = text_.size();
        if (old > longest_line && !any_length)
            throw FileError(file_, "line " + std::to_string(number_ + 1) + ": is longer than " +
                                       std::to_string(longest_line) + " characters; is it a CSV file?");
        text_.resize(old + piece);
        const std::size_t count = source_(text_.data() + old, piece);
        text_.resize(old + count);
        read_ += count;
        has_ended_ = count == 0;
        return count > 0;
    }

    PoseStream::Source source_;
    std::string file_;
    std::string text_;    ///< what was read
    std::size_t at_ = 0;  ///< where the next line begins in it
    std::uint64_t number_ = 0, read_ = 0;
    bool has_ended_ = false;
};

PoseStream::Source source_of(std::string text)
{
    return [text = std::move(text), at = std::size_t(0)](char* to, std::size_t size) mutable {
        const std::size_t count = text.copy(to, size, at);
        at += count;
        return count;
    };
}

PoseStream::Source source_of(const std::filesystem::path& file)
{
    return
        [stream = std::make_shared<std::ifstream>(open_file(file)), name = file.string()](char* to, std::size_t size) {
            stream->read(to, std::streamsize(size));
            if (stream->bad()) throw FileError(name, "cannot be read to its end");
            return std::size_t(stream->gcount());
        };
}

}  // namespace

class PoseStream::Impl {
public:
    Impl(Source source, std::string name, bool allow_empty, std::string prefix)
        : file_(std::move(name)), lines_(std::move(source), file_)
    {
        if (prefix.empty() && lines_.is_json()) lines_ = Lines(source_of(csv_of_json(lines_.rest(), file_)), file_);
        const std::optional<std::string_view> header = next_row();
        if (!header) throw FileError(file_, "is empty, " + PoseRows::needed_header(prefix));
        header_ = *header;
        columns_ = PoseRows(file_, std::move(prefix), header_, lines_.number());
        notices_ = columns_.name_notices();
        look_ahead();
        if (!waiting_ && !allow_empty) throw FileError(file_, "has a header but no pose; --allow-empty accepts that");
    }

    bool has_ended() const { return !waiting_; }
    std::uint64_t bytes() const { return lines_.bytes(); }

    PoseTable next(std::size_t most, int threads)
    {
        PoseTable table;
        table.header = header_;
        std::vector<std::uint64_t> numbers;  // of the lines
        for (; waiting_ && table.rows.size() < most; look_ahead()) {
            table.rows.push_back(std::move(*waiting_));
            numbers.push_back(lines_.number());
        }
        read_numbers(table, numbers, threads);
        has_poses_ |= !table.rows.empty();
        table.notices = std::exchange(notices_, {});
        if (!has_ended()) return table;
        for (std::string& text : columns_.turn_notices(std::exchange(beyond_, {})))
            table.notices.push_back(std::move(text));
        if (!std::exchange(has_poses_, true)) table.notices.push_back(file_ + ": has a header but no pose");
        return table;
    }

private:
    /// Returns the next line that is not blank.
    std::optional<std::string_view> next_row()
    {
        std::optional<std::string_view> line = lines_.next();
        while (line && line->find_first_not_of(" \t") == std::string_view::npos) line = lines_.next();
        return line;
    }

    void look_ahead()
    {
        const std::optional<std::string_view> row = next_row();
        waiting_ = row ? std::optional(std::string(*row)) : std::nullopt;
    }

    /// Fills the poses of a table whose rows are these lines of the file. Of several errors, the first one is thrown.
    void read_numbers(PoseTable& table, const std::vector<std::uint64_t>& lines, int threads)
    {
        constexpr std::size_t rows = 1 << 12;  // of a task
        table.poses.resize(table.rows.size());
        const std::size_t tasks = (table.rows.size() + rows - 1) / rows;
        std::vector<BeyondTurn> beyond(tasks);
        std::vector<std::exception_ptr> errors(tasks);
        parallel_for(tasks, threads, {}, [&](std::size_t task) {
            try {
                for (std::size_t i = task * rows; i < std::min(table.rows.size(), (task + 1) * rows); ++i)
                    table.poses[i] = columns_.pose(table.rows[i], lines[i], beyond[task]);
            } catch (...) {
                errors[task] = std::current_exception();
            }
        });
        for (std::size_t task = 0; task < tasks; ++task) {
            if (errors[task]) std::rethrow_exception(errors[task]);
            beyond_.add(beyond[task]);
        }
    }

    const std::string file_;
    Lines lines_;
    std::string header_;
    PoseRows columns_;
    std::vector<std::string> notices_;    ///< for the next table
    BeyondTurn beyond_;                   ///< of all rows so far
    std::optional<std::string> waiting_;  ///< the next row; nothing: the file has ended
    bool has_poses_ = false;
};

PoseStream::PoseStream(const std::filesystem::path& file, bool allow_empty)
    : PoseStream(source_of(file), file.string(), allow_empty)
{
    size_ = double(std::filesystem::file_size(file));
}

PoseStream::PoseStream(Source source, std::string name, bool allow_empty, std::string prefix)
    : impl_(std::make_unique<Impl>(std::move(source), std::move(name), allow_empty, std::move(prefix)))
{
}

PoseStream::PoseStream(PoseStream&&) noexcept = default;
PoseStream& PoseStream::operator=(PoseStream&&) noexcept = default;
PoseStream::~PoseStream() = default;

PoseTable PoseStream::next(std::size_t most, int threads) { return impl_->next(most, threads); }

bool PoseStream::has_ended() const { return impl_->has_ended(); }

double PoseStream::share() const { return has_ended() ? 1 : double(impl_->bytes()) / size_; }

PoseTable parse_poses(std::string_view text, const std::string& name, bool allow_empty, const std::string& prefix)
{
    const auto source = [text](char* to, std::size_t size) mutable {
        const std::size_t count = text.copy(to, size);
        text.remove_prefix(count);
        return count;
    };
    return PoseStream(source, name, allow_empty, prefix).next();
}

PoseTable read_poses(const std::filesystem::path& file, bool allow_empty)
{
    return PoseStream(file, allow_empty).next();
}

}  // namespace spawnfield
