// OutputTest.cpp - which files osgraytrace replaces, which it leaves, and its messages if it cannot
// write.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/apps/Program.h"

#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace
{

const std::string kBox = dataFile("cornell_box.osgt");
const std::string kQuick = " --size 8 8 --passes 1 ";
const std::string kPng = "\x89PNG\r\n\x1a\n";
using Names = std::vector<std::string>;

void write(const std::string& file, const std::string& text)
{
    std::ofstream(file, std::ios::binary) << text;
}

struct stat statusOf(const std::string& file)
{
    struct stat status = {};
    REQUIRE(lstat(file.c_str(), &status) == 0);
    return status;
}

bool isJson(const std::string& text)
{
    return nlohmann::json::accept(text);
}

} // namespace

TEST_CASE("osgraytrace: pipes and devices are written into, not replaced", "[apps]")
{
    const TemporaryFolder folder;
    for (const char* name : {"pipe.json", "pipe.png", "pipe.exr"})
        REQUIRE(mkfifo((folder / name).c_str(), 0600) == 0);
    const Outcome outcome = osgraytrace(
        folder,
        kBox + kQuick + "-o pipe.png -o pipe.exr --stats pipe.json; code=$?; wait; exit $code )",
        "( for name in pipe.json pipe.png pipe.exr; do timeout 60 cat $name > got.$name & done;");
    CHECK(outcome.exitCode == 0);
    CHECK(isJson(contents(folder / "got.pipe.json")));
    CHECK_THAT(contents(folder / "got.pipe.png"), StartsWith(kPng));
    CHECK_THAT(contents(folder / "got.pipe.exr"), StartsWith("\x76\x2f\x31\x01"));
    for (const char* name : {"pipe.json", "pipe.png", "pipe.exr"})
        CHECK(S_ISFIFO(statusOf(folder / name).st_mode));

    // The test makes a null device of its own if it may.
    if (mknod((folder / "null.png").c_str(), S_IFCHR | 0600, makedev(1, 3)) != 0) return;
    if (access((folder / "null.png").c_str(), W_OK) != 0) return;
    std::ofstream probe(folder / "null.png");
    if (!probe) return; // the file system has no devices
    const Outcome device =
        osgraytrace(folder, kBox + kQuick + "-o null.png -o other.png --stats null.png");
    CHECK(device.exitCode == 0);
    CHECK(S_ISCHR(statusOf(folder / "null.png").st_mode));
    CHECK_THAT(contents(folder / "other.png"), StartsWith(kPng));
}

TEST_CASE("osgraytrace: statistics to standard output stand before the last line", "[apps]")
{
    const TemporaryFolder folder;
    std::filesystem::create_symlink("/proc/self/fd/1", folder / "out.json");
    const Outcome outcome = osgraytrace(folder, kBox + kQuick + "-o x.png --stats out.json");
    CHECK(outcome.exitCode == 0);
    const size_t end = outcome.output.rfind("}\n");
    REQUIRE(end != std::string::npos);
    CHECK(isJson(outcome.output.substr(0, end + 1)));
    CHECK_THAT(outcome.output.substr(end), StartsWith("}\npath, 1 passes"));
    CHECK(folder.fileNames() == Names{"out.json", "x.png"});
}

TEST_CASE("osgraytrace: a file that is written again keeps mode, owner and links", "[apps]")
{
    const TemporaryFolder folder;
    for (const char* name : {"mode.png", "linked.png", "target.png"})
        write(folder / name, std::string(100000, 'x'));
    std::filesystem::permissions(folder / "mode.png", std::filesystem::perms(0640));
    std::filesystem::create_hard_link(folder / "linked.png", folder / "other.png");
    std::filesystem::create_symlink("target.png", folder / "link.png");
    std::filesystem::create_directory(folder / "sub");
    std::filesystem::create_symlink("sub/new.png", folder / "dangling.png");
    const bool root = geteuid() == 0;
    if (root) REQUIRE(chown((folder / "mode.png").c_str(), 12345, 54321) == 0);

    const Outcome outcome = osgraytrace(
        folder, kBox + kQuick + "-o mode.png -o linked.png -o link.png -o dangling.png -o new.png",
        "umask 027;");
    CHECK(outcome.exitCode == 0);
    const std::string picture = contents(folder / "new.png");
    CHECK_THAT(picture, StartsWith(kPng));
    for (const char* name : {"mode.png", "linked.png", "other.png", "target.png", "link.png",
                             "dangling.png", "sub/new.png"})
    {
        CAPTURE(name);
        CHECK(contents(folder / name) == picture);
    }
    CHECK((statusOf(folder / "mode.png").st_mode & 07777) == 0640);
    CHECK((statusOf(folder / "new.png").st_mode & 07777) == 0640); // 0666 without 027
    CHECK(statusOf(folder / "linked.png").st_ino == statusOf(folder / "other.png").st_ino);
    CHECK(S_ISLNK(statusOf(folder / "link.png").st_mode));
    CHECK(S_ISLNK(statusOf(folder / "dangling.png").st_mode));
    if (root)
    {
        CHECK(statusOf(folder / "mode.png").st_uid == 12345);
        CHECK(statusOf(folder / "mode.png").st_gid == 54321);
    }
    CHECK(folder.fileNames() == Names{"dangling.png", "link.png", "linked.png", "mode.png",
                                      "new.png", "other.png", "sub", "target.png"});
}

TEST_CASE("osgraytrace: a name may be as long as names can be", "[apps]")
{
    const TemporaryFolder folder;
    const std::string name = std::string(251, 'n') + ".png";
    CHECK(osgraytrace(folder, kBox + kQuick + "-o " + name).exitCode == 0);
    CHECK(folder.fileNames() == Names{name});
    const Outcome tooLong = osgraytrace(folder, kBox + kQuick + "-o n" + name);
    CHECK(tooLong.exitCode == 4);
    CHECK_THAT(tooLong.errors, Contains("File name too long"));
}

TEST_CASE("osgraytrace: two outputs that are one file are refused before rendering", "[apps]")
{
    const TemporaryFolder folder;
    write(folder / "x.png", "old");
    std::filesystem::create_symlink("x.png", folder / "link.png");
    std::filesystem::create_hard_link(folder / "x.png", folder / "hard.png");
    std::filesystem::create_symlink("new.png", folder / "dangling.png");
    const Names before = folder.fileNames();
    for (const std::string outputs :
         {"-o x.png --stats x.png", "-o x.png -o x.png", "-o x.png -o ./x.png",
          "-o x.png --stats link.png", "-o hard.png --stats x.png", "-o new.png --stats new.png",
          "-o dangling.png -o new.png"})
    {
        CAPTURE(outputs);
        const Outcome outcome = osgraytrace(folder, kBox + kQuick + outputs);
        CHECK(outcome.exitCode == 1);
        CHECK_THAT(outcome.errors, Contains("are the same file"));
        CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
        CHECK(contents(folder / "x.png") == "old");
        CHECK(folder.fileNames() == before);
    }
}

TEST_CASE("osgraytrace: what cannot be printed ends with 4", "[apps][long]")
{
    const TemporaryFolder folder;
    for (const std::string& arguments : {std::string("--list-options"), std::string("--help"),
                                         kBox + kQuick + "--report", kBox + kQuick + "-o x.png"})
    {
        CAPTURE(arguments);
        const Outcome full = osgraytrace(folder, arguments + " >/dev/full )", "(");
        CHECK(full.exitCode == 4);
        CHECK_THAT(full.errors, Contains("cannot write to standard output: "));
        const Outcome closed = osgraytrace(folder, arguments + " >&- )", "(");
        CHECK(closed.exitCode == 4);
        CHECK_THAT(closed.errors, Contains("cannot write to standard output"));
    }
    CHECK_THAT(contents(folder / "x.png"), StartsWith(kPng)); // written nevertheless
    CHECK(folder.fileNames() == Names{"x.png"});
}

TEST_CASE("osgraytrace: a size that a format cannot have leaves the other outputs", "[apps][long]")
{
    const TemporaryFolder folder;
    const Outcome wide = osgraytrace(
        folder, kBox + " --size 70000 1 --passes 1 -o a.jpg -o b.exr -o c.png --stats s.json");
    CHECK(wide.exitCode == 4);
    CHECK_THAT(wide.errors, Contains("osgraytrace: cannot write a.jpg: a .jpg is at most 65500"));
    CHECK(std::count(wide.errors.begin(), wide.errors.end(), '\n') == 1);
    CHECK(folder.fileNames() == Names{"b.exr", "c.png", "s.json"});

    const Outcome wider = osgraytrace(
        folder, kBox + " --integrator debug --size 1000001 1 --passes 1 -o d.png -o e.exr");
    CHECK(wider.exitCode == 4);
    CHECK_THAT(wider.errors, Contains("cannot write d.png: a .png is at most 1000000"));
    CHECK(folder.fileNames() == Names{"b.exr", "c.png", "e.exr", "s.json"});

    // No output would be left to render for.
    const Outcome alone = osgraytrace(folder, kBox + " --size 70000 1 --passes 16777216 -o a.jpg");
    CHECK(alone.exitCode == 4);
}

TEST_CASE("osgraytrace: a write that fails leaves the other outputs", "[apps]")
{
    // No file may grow beyond 1 KiB.
    for (const std::string picture : {"x.exr", "x.png", "x.jpg"})
    {
        CAPTURE(picture);
        const TemporaryFolder folder;
        write(folder / picture, "old");
        std::filesystem::create_hard_link(folder / picture, folder / "hard");
        const Outcome outcome =
            osgraytrace(folder, kBox + " --passes 1 --size 200 200 --stats s.json -o " + picture,
                        "ulimit -f 4 &&");
        CHECK(outcome.exitCode == 4);
        CHECK_THAT(outcome.errors,
                   StartsWith("osgraytrace: cannot write " + picture + ": File too large"));
        CHECK(contents(folder / picture) == "old");
        CHECK(isJson(contents(folder / "s.json")));
        CHECK(folder.fileNames() == Names{"hard", "s.json", picture});
    }
}

TEST_CASE("osgraytrace: a message on standard error is one write", "[apps]")
{
    // A pipe of packets keeps the writes apart. The programs of mpirun write to one pipe together.
    int pipe[2];
    REQUIRE(pipe2(pipe, O_DIRECT | O_NONBLOCK) == 0);
    const TemporaryFolder folder;
    // The shell knows descriptors of one digit.
    REQUIRE(dup2(pipe[1], 9) == 9);
    const std::string command = "cd '" + folder / "." + "' && timeout 60 '" +
                                OSGRAYTRACE_TEST_PROGRAM + "' none.osgt -o x.png 2>&9";
    const int status = std::system(command.c_str());
    REQUIRE(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 2);
    char packet[4096];
    std::string last;
    for (ssize_t size; (size = read(pipe[0], packet, sizeof packet)) > 0;)
        last.assign(packet, static_cast<std::size_t>(size));
    close(pipe[0]);
    close(pipe[1]);
    close(9);
    CHECK_THAT(last, StartsWith("osgraytrace: cannot load none.osgt"));
    CHECK(last.find('\n') == last.size() - 1);
}
