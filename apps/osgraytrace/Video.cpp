// Video.cpp - runs ffmpeg at the other end of a pipe. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Video.h"

#include "osgRayTrace/base/NumberText.h"

#include <osgDB/FileNameUtils>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <map>
#include <sstream>
#include <stdexcept>

extern char** environ;

namespace osgRayTrace::app
{

namespace
{

/// ffmpeg's formats by extension.
const std::map<std::string, std::string>& formats()
{
    static const std::map<std::string, std::string> known = {
        {"mp4", "mp4"}, {"mov", "mov"}, {"mkv", "matroska"}, {"webm", "webm"}};
    return known;
}

[[noreturn]] void fail(const std::string& what, int error)
{
    throw std::runtime_error(what + ": " + std::strerror(error));
}

/// Returns ffmpeg's command line. Its colours are those of BT.709, and the sides of what it encodes
/// are even, as players need them.
std::vector<std::string> commandLine(const std::string& name, const std::string& file,
                                     double framesPerSecond, int width, int height)
{
    const std::string format = formats().at(osgDB::getLowerCaseFileExtension(name));
    return {"ffmpeg",
            "-hide_banner",
            "-loglevel",
            "error",
            "-f",
            "rawvideo",
            "-pix_fmt",
            "rgb24",
            "-video_size",
            std::to_string(width) + "x" + std::to_string(height),
            "-framerate",
            engine::numberText(framesPerSecond),
            "-i",
            "pipe:0",
            "-vf",
            "crop=trunc(iw/2)*2:trunc(ih/2)*2:0:0,scale=out_color_matrix=bt709,format=yuv420p",
            "-colorspace",
            "bt709",
            "-color_primaries",
            "bt709",
            "-color_trc",
            "bt709",
            "-crf",
            "18",
            "-f",
            format,
            "-y",
            "file:" + file}; // a name with a colon is no protocol
}

/// Sets the attributes with which a child is not stopped by the terminal's Ctrl-C: it is to finish
/// its file.
class ApartFromTerminal
{
public:
    ApartFromTerminal()
    {
        posix_spawnattr_init(&_attributes);
        posix_spawnattr_setflags(&_attributes, POSIX_SPAWN_SETPGROUP);
    }
    ~ApartFromTerminal() { posix_spawnattr_destroy(&_attributes); }
    ApartFromTerminal(const ApartFromTerminal&) = delete;
    ApartFromTerminal& operator=(const ApartFromTerminal&) = delete;

    const posix_spawnattr_t* get() const { return &_attributes; }

private:
    posix_spawnattr_t _attributes;
};

/// Starts a program that reads from a descriptor. Returns its process.
int spawn(std::vector<std::string> arguments, int input)
{
    std::vector<char*> pointers;
    for (std::string& argument : arguments)
        pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    const ApartFromTerminal attributes;
    pid_t process = -1;
    const int error =
        posix_spawnp(&process, pointers[0], &actions, attributes.get(), pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) fail("ffmpeg cannot be started", error);
    return process;
}

/// Sets the bytes of a picture without alpha, its top row first.
void setRgb(const osg::Image& frame, std::vector<unsigned char>& rgb)
{
    rgb.clear();
    for (int y = frame.t() - 1; y >= 0; --y)
    {
        const unsigned char* row = frame.data(0, y);
        for (int x = 0; x < frame.s(); ++x)
            rgb.insert(rgb.end(), row + 4 * x, row + 4 * x + 3);
    }
}

} // namespace

bool isVideo(const std::string& path)
{
    return formats().count(osgDB::getLowerCaseFileExtension(path)) > 0;
}

std::string whyNoVideo()
{
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (access((folder + "/ffmpeg").c_str(), X_OK) == 0) return "";
    return "videos need ffmpeg, which is not installed; write frames, as in -o out.%04d.png";
}

Video::Video(const std::string& name, const std::string& file, double framesPerSecond)
    : _name(name), _file(file), _framesPerSecond(framesPerSecond)
{
}

Video::~Video()
{
    if (_process < 0) return;
    kill(_process, SIGKILL);
    endInput();
    while (waitpid(_process, nullptr, 0) < 0 && errno == EINTR)
        continue;
}

void Video::start(int width, int height)
{
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) fail("no pipe", errno);
    _pipe = ends[1];
    try
    {
        _process = spawn(commandLine(_name, _file, _framesPerSecond, width, height), ends[0]);
    }
    catch (...)
    {
        close(ends[0]);
        endInput();
        throw;
    }
    close(ends[0]);
}

void Video::endInput()
{
    if (_pipe >= 0) close(_pipe);
    _pipe = -1;
}

void Video::add(const osg::Image& frame)
{
    if (_process < 0) start(frame.s(), frame.t());
    setRgb(frame, _rgb);
    for (std::size_t written = 0; written < _rgb.size();)
    {
        const ssize_t more = write(_pipe, _rgb.data() + written, _rgb.size() - written);
        if (more < 0 && errno == EINTR) continue;
        if (more < 0) fail("ffmpeg takes no more frames", errno);
        written += static_cast<std::size_t>(more);
    }
}

void Video::finish()
{
    if (_process < 0) throw std::runtime_error("there are no frames");
    endInput();
    int status = 0;
    while (waitpid(_process, &status, 0) < 0)
        if (errno != EINTR) fail("ffmpeg", errno);
    _process = -1;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw std::runtime_error("ffmpeg ended with an error");
}

} // namespace osgRayTrace::app
