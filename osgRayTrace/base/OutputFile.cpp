// OutputFile.cpp - writes temporary files beside their destinations. Layer: base.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/base/OutputFile.h"

#include "osgRayTrace/base/Destination.h"
#include "osgRayTrace/base/TemporaryFile.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>

namespace osgRayTrace::engine
{

namespace fs = std::filesystem;

namespace
{

/// Returns the descriptor of standard output or standard error if that goes to the destination,
/// else -1. Text and contents written through two descriptors would overwrite each other.
int standardDescriptor(const struct stat& destination)
{
    for (const int number : {STDOUT_FILENO, STDERR_FILENO})
    {
        struct stat standard;
        const bool same = fstat(number, &standard) == 0 && isSame(standard, destination);
        if (same && !S_ISCHR(destination.st_mode)) return number;
    }
    return -1;
}

void copyAll(int from, int to)
{
    if (lseek(from, 0, SEEK_SET) != 0) fail(errno);
    std::array<char, 1 << 16> buffer;
    for (;;)
    {
        const ssize_t count = read(from, buffer.data(), buffer.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail(errno);
        if (count == 0) return;
        for (ssize_t done = 0; done < count;)
        {
            const ssize_t written =
                ::write(to, buffer.data() + done, static_cast<size_t>(count - done));
            if (written < 0 && errno != EINTR) fail(errno);
            if (written > 0) done += written;
        }
    }
}

/// Copies the contents into an existing file, which keeps its attributes. Space for the contents is
/// reserved first, so that a full disk leaves the file alone.
void copyIntoFile(int from, const std::string& path)
{
    Descriptor to(open(path.c_str(), O_WRONLY | O_CLOEXEC));
    struct stat source, before;
    if (*to < 0 || fstat(from, &source) != 0 || fstat(*to, &before) != 0) fail(errno);
    if (source.st_size > 0)
    {
        const int error = posix_fallocate(*to, 0, source.st_size);
        const bool unknown = error == EOPNOTSUPP || error == EINVAL; // unknown to this file system
        if (error != 0 && !unknown)
        {
            if (ftruncate(*to, before.st_size) != 0) fail(errno);
            fail(error);
        }
    }
    copyAll(from, *to);
    if (ftruncate(*to, source.st_size) != 0) fail(errno);
    to.finish();
}

void copyIntoSpecial(int from, const std::string& path, int standard)
{
    std::fflush(nullptr); // earlier printed text comes first
    if (standard >= 0) return copyAll(from, standard);
    Descriptor to(open(path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC));
    if (*to < 0) fail(errno);
    copyAll(from, *to);
    to.finish();
}

/// Gives the temporary file the owner, group and mode of the file that it shall replace. Returns
/// false if the temporary file cannot have them, or if a rename would lose something else.
bool becomeAlike(int temporary, const fs::path& file, const struct stat& wanted)
{
    struct stat now, named;
    const bool isName = stat(file.c_str(), &named) == 0 && isSame(named, wanted);
    if (!isName || wanted.st_nlink != 1) return false;
    if (listxattr(file.c_str(), nullptr, 0) > 0) return false; // access control lists or others
    if (fstat(temporary, &now) != 0) return false;
    const bool owned = now.st_uid == wanted.st_uid && now.st_gid == wanted.st_gid;
    if (!owned && fchown(temporary, wanted.st_uid, wanted.st_gid) != 0) return false;
    return fchmod(temporary, wanted.st_mode & 07777) == 0;
}

/// Returns a temporary file beside the destination, where a rename can reach the destination. If
/// the destination is no regular file, or if it exists and its folder takes no new file, the
/// temporary file is in the folder for temporary files, and is copied from there.
std::unique_ptr<TemporaryFile> newTemporaryFile(const Destination& destination)
{
    if (destination.found && !destination.isRegular())
        return std::make_unique<TemporaryFile>(fs::temp_directory_path(), 0600);
    const mode_t mode = destination.found ? destination.found->st_mode & 0777 : 0666;
    try
    {
        return std::make_unique<TemporaryFile>(folderOf(destination.file), mode);
    }
    catch (const std::runtime_error&)
    {
        if (!destination.found || errno == ENOSPC || errno == EDQUOT) throw;
        return std::make_unique<TemporaryFile>(fs::temp_directory_path(), 0600);
    }
}

bool mayAccess(const fs::path& path, int mode)
{
    return faccessat(AT_FDCWD, path.c_str(), mode, AT_EACCESS) == 0;
}

} // namespace

std::string whyNotWritable(const std::string& path)
{
    const Destination destination = destinationOf(path);
    if (destination.error) return std::strerror(destination.error);
    if (destination.found && S_ISDIR(destination.found->st_mode)) return "it is a folder";
    if (destination.found)
        return standardDescriptor(*destination.found) >= 0 || mayAccess(path, W_OK)
                   ? ""
                   : std::strerror(errno);
    if (!destination.file.has_filename()) return std::strerror(ENOENT);

    const fs::path folder = folderOf(destination.file);
    std::error_code error;
    if (!fs::is_directory(folder, error)) return "there is no folder " + folder.string();
    return mayAccess(folder, W_OK | X_OK) ? "" : std::strerror(errno);
}

bool isSameFile(const std::string& a, const std::string& b)
{
    const Destination first = destinationOf(a), second = destinationOf(b);
    if (first.found && second.found)
        return first.isRegular() && isSame(*first.found, *second.found);
    if (first.found || second.found) return false;
    struct stat folderA, folderB;
    return first.file.filename() == second.file.filename() &&
           stat(folderOf(first.file).c_str(), &folderA) == 0 &&
           stat(folderOf(second.file).c_str(), &folderB) == 0 && isSame(folderA, folderB);
}

void writeFileWhole(const std::string& path,
                    const std::function<void(const std::string& temporary)>& write)
{
    const Destination destination = destinationOf(path);
    if (destination.error) fail(destination.error);
    const std::unique_ptr<TemporaryFile> temporary = newTemporaryFile(destination);
    write(temporary->path());

    const int standard = destination.found ? standardDescriptor(*destination.found) : -1;
    if (standard >= 0 || (destination.found && !destination.isRegular()))
        return copyIntoSpecial(temporary->file(), path, standard);
    if (!destination.found)
    {
        if (!temporary->renameTo(destination.file.string())) fail(errno);
        return;
    }
    const bool alike = becomeAlike(temporary->file(), destination.file, *destination.found);
    if (alike && temporary->renameTo(destination.file.string())) return;
    copyIntoFile(temporary->file(), path);
}

} // namespace osgRayTrace::engine
