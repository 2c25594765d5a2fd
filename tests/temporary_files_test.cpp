#include "arena.h"

#include "base/temporary.h"

#include <spawnfield/error.h>
#include <spawnfield/leftovers.h>
#include <spawnfield/output_file.h>
#include <spawnfield/output_folder.h>

#include <sys/stat.h>
#include <sys/wait.h>

#include <functional>

using namespace spawnfield;

namespace fs = std::filesystem;

namespace {

using Names = std::set<std::string>;

std::string no_objection(const fs::path&) { return ""; }

/// Runs work in another process, which then kills itself.
void run_and_kill(const std::function<void()>& work)
{
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        work();
        raise(SIGKILL);
    }
    int status = 0;
    waitpid(child, &status, 0);
    REQUIRE(WIFSIGNALED(status));
}

void leave_file(const fs::path& target)
{
    run_and_kill([&] {
        OutputFile out(target);
        out.write("a part");
        out.flush();
        raise(SIGKILL);
    });
}

void leave_folder(const fs::path& target)
{
    run_and_kill([&] {
        OutputFolder out(target, no_objection);
        write_file_atomically(out.path() / "part", "a part");
        raise(SIGKILL);
    });
}

void write_folder(const fs::path& target, const std::string& text)
{
    OutputFolder out(target, no_objection);
    write_file_atomically(out.path() / "file", text);
    out.commit();
    CHECK(out.notices().empty());
}

mode_t mode_of(const fs::path& path)
{
    struct stat about {};
    REQUIRE(stat(path.c_str(), &about) == 0);
    return about.st_mode & 07777;
}

/// Sets the umask until the end.
class Umask {
public:
    explicit Umask(mode_t mask) : before_(umask(mask)) {}
    ~Umask() { umask(before_); }

private:
    mode_t before_;
};

}  // namespace

TEST_CASE("temporary names are recognized, and names that a user chose are not")
{
    const fs::path target = "some.folder/map.tmp-x";
    for (const TemporaryKind kind : {TemporaryKind::New, TemporaryKind::Old}) {
        const fs::path path = temporary_path(target, kind);
        CHECK(temporary_path(target, kind) != path);
        const auto name = parse_temporary(path);
        REQUIRE(name);
        CHECK(name->target == target);
        CHECK(name->kind == kind);
        std::string other = path.string();
        other.back() = other.back() == 'a' ? 'b' : 'a';
        CHECK_FALSE(parse_temporary(other));
        CHECK_FALSE(parse_temporary(path.string() + "0"));
        CHECK_FALSE(parse_temporary(path.parent_path() / ("other" + path.filename().string())));
    }
    for (const char* const name : {"map", "map.tmp-", "map.tmp-123", "map.old-backup", "map.old-abcdefghijkl", ".tmp-"})
        CHECK_FALSE(parse_temporary(name));
}

TEST_CASE("nothing that exists under a name like a temporary one is followed, adopted or removed")
{
    const TempFolder folder;
    folder.write("victim", "precious");
    const std::string process = std::to_string(getpid());
    const Names planted{"out.tmp-" + process, "out.old-" + process, "out.tmp-abcdef", "out.tmp-abcdefgh0123"};
    for (const std::string& name : planted) fs::create_symlink("victim", folder / name);
    fs::create_symlink("victim", temporary_path(folder / "out", TemporaryKind::New));
    folder.write("out.old-backup", "mine");
    write_file_atomically(folder / "out", "result");
    write_folder(folder / "made", "result");
    CHECK(bytes_of(folder / "out") == "result");
    CHECK(bytes_of(folder / "victim") == "precious");
    CHECK(bytes_of(folder / "out.old-backup") == "mine");
    CHECK(clean_folder(folder.path()).empty());
    CHECK(names_in(folder.path()).size() == planted.size() + 5);
}

TEST_CASE("what a killed run leaves is removed by the next run for the same result, and only for it")
{
    const TempFolder folder;
    leave_file(folder / "out");
    leave_file(folder / "other");
    leave_folder(folder / "map");
    CHECK(names_in(folder.path()).size() == 3);
    write_file_atomically(folder / "out", "result");
    write_folder(folder / "map", "result");
    Names names = names_in(folder.path());
    CHECK(names.erase("out") + names.erase("map") == 2);
    REQUIRE(names.size() == 1);
    CHECK(names.begin()->starts_with("other.tmp-"));
    CHECK(bytes_of(folder / "out") == "result");
    CHECK(bytes_of(folder / "map/file") == "result");
}

TEST_CASE("the files of a living run stay while another one writes the same result")
{
    const TempFolder folder;
    OutputFile file(folder / "out");
    OutputFolder map(folder / "map", no_objection);
    write_file_atomically(map.path() / "file", "first");
    file.write("first");
    write_file_atomically(folder / "out", "second");
    write_folder(folder / "map", "second");
    CHECK(clean_folder(folder.path(), {.recursive = true}).empty());
    CHECK(bytes_of(folder / "out") == "second");
    CHECK(bytes_of(folder / "map/file") == "second");
    file.commit();
    map.commit();
    CHECK(bytes_of(folder / "out") == "first");
    CHECK(bytes_of(folder / "map/file") == "first");
    CHECK(names_in(folder.path()) == Names{"out", "map"});
}

TEST_CASE("an old result that lost its name is put back, and one that was replaced is removed")
{
    const TempFolder folder;
    const fs::path lost = temporary_path(folder / "map", TemporaryKind::Old),
                   lost_file = temporary_path(folder / "out", TemporaryKind::Old),
                   replaced = temporary_path(folder / "new", TemporaryKind::Old);
    folder.write(lost.filename().string() + "/file", "old");
    folder.write(lost_file.filename().string(), "old");
    folder.write(replaced.filename().string() + "/file", "old");
    folder.write("new/file", "new");
    {
        const OutputFolder map(folder / "map", no_objection);
        CHECK(bytes_of(folder / "map/file") == "old");
        CHECK(map.notices() ==
              std::vector<std::string>{(folder / "map").string() + " was put back: a killed run had left it as " +
                                       lost.filename().string()});
    }
    CHECK(bytes_of(folder / "map/file") == "old");
    const std::vector<Leftover> cleaned = clean_folder(folder.path());
    REQUIRE(cleaned.size() == 2);
    CHECK(cleaned[0].path == replaced);
    CHECK(cleaned[0].put_back_to.empty());
    CHECK(cleaned[1].path == lost_file);
    CHECK(cleaned[1].put_back_to == folder / "out");
    CHECK(bytes_of(folder / "out") == "old");
    CHECK(names_in(folder.path()) == Names{"map", "out", "new"});
}

TEST_CASE("of several old results the latest is put back")
{
    const TempFolder folder;
    for (const char* const text : {"first", "second"}) {
        const fs::path old = temporary_path(folder / "out", TemporaryKind::Old);
        folder.write(old.filename().string(), text);
        usleep(20000);  // so that the times of the files differ
    }
    CHECK(clean_folder(folder.path()).size() == 2);
    CHECK(bytes_of(folder / "out") == "second");
    CHECK(names_in(folder.path()) == Names{"out"});
}

TEST_CASE("results have the permissions that the umask leaves")
{
    const TempFolder folder;
    for (const mode_t mask : {mode_t(0022), mode_t(0077), mode_t(0002)}) {
        const Umask set(mask);
        write_file_atomically(folder / "out", "text");
        write_folder(folder / "map", "text");
        CHECK(mode_of(folder / "out") == (0666 & ~mask));
        CHECK(mode_of(folder / "map") == (0777 & ~mask));
        CHECK(mode_of(folder / "map/file") == (0666 & ~mask));
    }
}

TEST_CASE("kept entries of a folder stay the same files, with all that was added to them")
{
    const TempFolder folder;
    folder.write("map/file", "old");
    folder.write("map/notes/day", "mine");
    folder.write("map/list", "mine");
    fs::create_symlink("nowhere", folder / "map/link");
    OutputFolder out(folder / "map", no_objection);
    write_file_atomically(out.path() / "file", "new");
    out.commit([](const fs::path& name) { return name != "file"; });
    CHECK(out.notices().empty());
    CHECK(bytes_of(folder / "map/file") == "new");
    CHECK(bytes_of(folder / "map/notes/day") == "mine");
    CHECK(bytes_of(folder / "map/list") == "mine");
    CHECK(fs::read_symlink(folder / "map/link") == "nowhere");
    CHECK(names_in(folder.path()) == Names{"map"});
    CHECK(names_in(folder / "map") == Names{"file", "notes", "list", "link"});
}

TEST_CASE("a folder that someone filled during the work is not replaced")
{
    const TempFolder folder;
    constexpr const char* names[] = {"file"};
    {
        OutputFolder out(folder / "map", holds_only(names, "test"));
        write_file_atomically(out.path() / "file", "new");
        folder.write("map/diary", "mine");
        CHECK_THROWS_WITH(out.commit(), (folder / "map").string() +
                                            ": contains diary, which is not part of any test; choose another name or "
                                            "remove it");
    }
    CHECK(names_in(folder.path()) == Names{"map"});
    CHECK(names_in(folder / "map") == Names{"diary"});
}

TEST_CASE("an old folder that cannot be removed is reported, and the new one is in its place")
{
    const TempFolder folder;
    folder.write("map/locked/file", "old");
    fs::permissions(folder / "map/locked", fs::perms(0555));
    const pid_t child = fork();
    if (child == 0) {
        // The superuser can remove anything, so the child is nobody.
        if (geteuid() == 0 && (chown(folder.path().c_str(), 65534, 65534) != 0 ||
                               chown((folder / "map").c_str(), 65534, 65534) != 0 || setuid(65534) != 0))
            _exit(2);
        OutputFolder out(folder / "map", no_objection);
        write_file_atomically(out.path() / "file", "new");
        out.commit();
        const bool is_right =
            out.notices().size() == 1 && out.notices()[0].starts_with((folder / "map.old-").string()) &&
            out.notices()[0].ends_with(", the former map, could not be removed: Permission denied; remove it by hand");
        _exit(is_right ? 0 : 1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    CHECK(status == 0);
    CHECK(bytes_of(folder / "map/file") == "new");
    for (const auto& entry : fs::directory_iterator(folder.path()))
        if (fs::exists(entry.path() / "locked")) fs::permissions(entry.path() / "locked", fs::perms(0755));
}

TEST_CASE("clean lists, and then removes, what killed runs left")
{
    const TempFolder folder;
    folder.write("below/poses.csv.tmp-notes", "mine");
    leave_file(folder / "out.csv");
    leave_folder(folder / "below/map");
    const fs::path old = temporary_path(folder / "map", TemporaryKind::Old);
    folder.write(old.filename().string() + "/file", "old");
    OutputFile living(folder / "living");
    const Names before = names_in(folder.path()), below = names_in(folder / "below");
    const std::string file = [&] {
        for (const std::string& name : before)
            if (name.starts_with("out.csv.tmp-")) return name;
        return std::string();
    }();
    const std::string renaming = old.filename().string() + " to map\n";

    const ProgramRun dry = run_program(folder, "clean . --dry-run");
    CHECK(dry.status == 0);
    CHECK(dry.out == "would rename " + renaming + "would remove " + file + "\n");
    CHECK_THAT(dry.err, Contains("spawnfield clean: .; 2 leftovers found; "));
    CHECK(names_in(folder.path()) == before);

    const ProgramRun run = run_program(folder, "clean .");
    CHECK(run.status == 0);
    CHECK(run.out == "renamed " + renaming + "removed " + file + "\n");
    CHECK(bytes_of(folder / "map/file") == "old");
    CHECK(names_in(folder / "below") == below);

    const ProgramRun deep = run_program(folder, "clean . --recursive -q");
    CHECK_THAT(deep.out, Catch::Matchers::StartsWith("removed below/map.tmp-"));
    CHECK(deep.err.empty());
    CHECK(names_in(folder / "below") == Names{"poses.csv.tmp-notes"});
    CHECK(names_in(folder.path()).size() == 3);  // below, map, and that of the living run

    const ProgramRun none = run_program(folder, "clean none");
    CHECK(none.status == 4);
    CHECK(none.err == "spawnfield: none: cannot be read: No such file or directory\n");
}

TEST_CASE("a killed bake leaves nothing that stays after the next one")
{
    const Arena arena;
    for (int i = 0; i < 3; ++i) {
        const ProgramRun run = interrupt_program(arena, "bake " + training_scene + " -o map --resolution 0.0025",
                                                 SIGKILL);
        CHECK(run.status == 137);
    }
    CHECK(arena.names().size() > 1);
    CHECK(arena("info map --verify -q").status == 0);
    CHECK(arena("bake " + training_scene + " -o map --resolution 0.2").status == 0);
    CHECK(arena.names() == Names{"map"});
    CHECK(arena("info map --verify -q").status == 0);
}
