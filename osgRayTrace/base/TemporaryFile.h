// TemporaryFile.h - private files of this process, which a signal handler can remove. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <string>

namespace osgRayTrace::engine
{

/// Throws std::runtime_error with the text of an error number.
[[noreturn]] void fail(int error);

/// Owns a file descriptor.
class Descriptor
{
public:
    explicit Descriptor(int number) : _number(number) {}
    ~Descriptor()
    {
        if (_number >= 0) close(_number);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    int operator*() const { return _number; }

    /// Closes the descriptor and throws errors that only closing finds, on file systems over a
    /// network.
    void finish()
    {
        const int number = _number;
        _number = -1;
        if (close(number) != 0 && errno != EINTR) fail(errno);
    }

private:
    int _number;
};

struct TemporaryName; // an entry of a list for signal handlers

/// A private file of this process. The file is removed with the object, unless it was renamed.
class TemporaryFile
{
public:
    /// Creates a file in the folder. Its name is short: the destination's name may be as long as
    /// names can be.
    TemporaryFile(const std::filesystem::path& folder, mode_t mode);
    ~TemporaryFile();
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    const std::string& path() const { return _path; }
    int file() const { return _file; }

    bool renameTo(const std::string& path)
    {
        _renamed = std::rename(_path.c_str(), path.c_str()) == 0;
        return _renamed;
    }

private:
    std::string _path;
    TemporaryName* _name = nullptr;
    int _file = -1;
    bool _renamed = false;
};

/// Removes the temporary files of all calls at work, for a process that is about to end.
/// The function is async-signal-safe.
void removeTemporaryFiles() noexcept;

} // namespace osgRayTrace::engine
