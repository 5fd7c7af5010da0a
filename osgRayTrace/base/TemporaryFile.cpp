// TemporaryFile.cpp - temporary files, and the list of their names. Layer: base.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/base/TemporaryFile.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <array>
#include <atomic>
#include <climits>
#include <cstring>
#include <stdexcept>

namespace osgRayTrace::engine
{

namespace fs = std::filesystem;

/// The name of a temporary file, for signal handlers: its memory is always there and never moves.
struct TemporaryName
{
    enum State
    {
        Free,
        Changing, ///< while path is written
        Used,
    };
    std::atomic<int> state{Free};
    char path[PATH_MAX];
};

namespace
{

std::array<TemporaryName, 16> temporaryNames;

/// Returns the entry of a new name; null if there are too many names, or if the path is too long. A
/// file without an entry would stay after a signal.
TemporaryName* registerTemporary(const std::string& path)
{
    if (path.size() >= PATH_MAX) return nullptr;
    for (TemporaryName& name : temporaryNames)
    {
        int expected = TemporaryName::Free;
        if (!name.state.compare_exchange_strong(expected, TemporaryName::Changing)) continue;
        std::memcpy(name.path, path.c_str(), path.size() + 1);
        name.state = TemporaryName::Used;
        return &name;
    }
    return nullptr;
}

} // namespace

void fail(int error)
{
    throw std::runtime_error(std::strerror(error));
}

TemporaryFile::TemporaryFile(const fs::path& folder, mode_t mode)
{
    static std::atomic<unsigned> number{0};
    do
    {
        _path =
            (folder / (".osgraytrace-" + std::to_string(getpid()) + "-" + std::to_string(++number)))
                .string();
        _file = open(_path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    } while (_file < 0 && errno == EEXIST);
    if (_file < 0) fail(errno);
    _name = registerTemporary(_path);
}

TemporaryFile::~TemporaryFile()
{
    if (!_renamed) unlink(_path.c_str());
    if (_name) _name->state = TemporaryName::Free;
    close(_file);
}

void removeTemporaryFiles() noexcept
{
    for (TemporaryName& name : temporaryNames)
        if (name.state == TemporaryName::Used) unlink(name.path);
}

} // namespace osgRayTrace::engine
