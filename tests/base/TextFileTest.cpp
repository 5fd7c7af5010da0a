// TextFileTest.cpp - files are read if they have an end, and refused with the reason if not.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/base/TextFile.h"
#include "tests/Catch.h"
#include "tests/plugins/TemporaryFolder.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>

using namespace osgRayTrace::engine;
using Catch::Matchers::Contains;

TEST_CASE("text files: regular ones and links to them are read to their last byte", "[base]")
{
    const TemporaryFolder folder;
    const std::string text = "a\r\nb\0c" + std::string(10000, 'x') + '\0';
    std::ofstream(folder / "file", std::ios::binary) << text;
    CHECK(readTextFile(folder / "file", text.size()).text == text);
    CHECK(readTextFile(folder / "file", text.size()).error == "");
    CHECK_THAT(readTextFile(folder / "file", text.size() - 1).error, Contains("has more than"));
    std::filesystem::create_symlink("file", folder / "link");
    CHECK(readTextFile(folder / "link", text.size()).text == text);
    std::ofstream(folder / "empty").flush();
    CHECK(readTextFile(folder / "empty", 0).error == "");
}

TEST_CASE("text files: what may have no end is refused by its kind, and nobody waits", "[base]")
{
    const TemporaryFolder folder;
    const auto errorOf = [](const std::string& file) { return readTextFile(file, 100).error; };
    CHECK(errorOf(folder / "none") == "there is no such file");
    CHECK(errorOf("") == "there is no such file");
    CHECK(errorOf(folder / ".") == "is a directory");
    CHECK(errorOf("/dev/zero") == "is a device");
    CHECK(errorOf("/dev/null") == "is a device");
    REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
    CHECK_THAT(errorOf(folder / "pipe"), Contains("is a pipe") && Contains("<(...)"));
    std::filesystem::create_symlink("pipe", folder / "linked pipe");
    CHECK_THAT(errorOf(folder / "linked pipe"), Contains("is a pipe"));
    std::filesystem::create_symlink("gone", folder / "dangling");
    CHECK(errorOf(folder / "dangling") == "there is no such file");

    sockaddr_un address = {};
    address.sun_family = AF_UNIX;
    const std::string path = folder / "socket";
    REQUIRE(path.size() < sizeof address.sun_path);
    std::memcpy(address.sun_path, path.c_str(), path.size());
    const int socketFile = socket(AF_UNIX, SOCK_STREAM, 0);
    REQUIRE(bind(socketFile, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    CHECK(errorOf(path) == "is a socket");
    close(socketFile);
}
