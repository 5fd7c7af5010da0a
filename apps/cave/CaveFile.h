// CaveFile.h - reads CalVR's configuration files and looks values up in them. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgRayTrace::app
{

/// Holds one element of a file. Files look like XML and often are not: several elements at the top,
/// no blanks between attributes.
struct CaveElement
{
    std::string name;
    int line = 0;
    std::string file;
    std::vector<std::pair<std::string, std::string>> attributes;
    std::string text;
    std::deque<CaveElement> children;

    /// Returns the attribute of this name; null if there is none.
    const std::string* attribute(const std::string& attributeName) const;
};

/// Limits the size of a configuration with its included files: no real one comes near.
constexpr std::size_t kMostCaveBytes = std::size_t(4) << 20;
constexpr std::size_t kMostCaveParts = 50000; ///< elements and attributes

/// Returns the elements of a text, below one that stands for the file. partsLeft: elements and
/// attributes that there may be, which the function lowers by those that there are. Throws
/// Failure(kCannotLoad) with the file and the line.
CaveElement parseCave(const std::string& text, const std::string& file, std::size_t& partsLeft);

/// Holds a file and those that it includes, for one host: GLOBAL is unwrapped, and so is LOCAL if
/// its list of hosts has this one.
class CaveFile
{
public:
    /// Reads a file. Included files are looked for beside the one that names them, then in
    /// CALVR_CONFIG_DIR. Throws Failure(kCannotLoad), also for a path that is no regular file and
    /// for more than kMostCaveBytes or kMostCaveParts.
    CaveFile(const std::string& file, const std::string& host);

    struct Value
    {
        std::string text;
        const CaveElement* element = nullptr; ///< element with the value
    };

    /// Returns the value of the first element that has the attribute, depth first; elements of
    /// included files come last. path: names of elements from the top, "A.B:2.C"; ":2" asks for
    /// name="2".
    std::optional<Value> find(const std::string& path,
                              const std::string& attribute = "value") const;

    /// Returns a number, or otherwise if there is none. Throws Failure(kCannotLoad) with file,
    /// line, element and attribute if the value is no finite number.
    double number(const std::string& path, const std::string& attribute, double otherwise) const;

    /// Returns a whole number, or otherwise if there is none. Throws like number() if the value is
    /// no whole number, or outside of the range.
    int integer(const std::string& path, const std::string& attribute, int otherwise, int least,
                int most) const;

    /// Returns a flag: "on" and "true" in any case are true, everything else is false.
    bool flag(const std::string& path, const std::string& attribute, bool otherwise) const;

    std::string text(const std::string& path, const std::string& attribute,
                     const std::string& otherwise) const;

    const std::string& name() const { return _roots.front().file; }

private:
    void load(const std::string& file, const std::string& host);

    std::deque<CaveElement> _roots; ///< one for each file
    std::size_t _bytesLeft = kMostCaveBytes, _partsLeft = kMostCaveParts;
};

} // namespace osgRayTrace::app
