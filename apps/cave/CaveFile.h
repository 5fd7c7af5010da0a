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

/// One element of a file. They look like XML and often are not: several at the top, no blanks
/// between attributes.
struct CaveElement
{
    std::string name;
    int line = 0;
    std::string file;
    std::vector<std::pair<std::string, std::string>> attributes;
    std::string text;
    std::deque<CaveElement> children;

    /// Null: it has none of this name.
    const std::string* attribute(const std::string& attributeName) const;
};

/// What a configuration may hold, files that it includes among it: none of a real one comes near.
constexpr std::size_t kMostCaveBytes = std::size_t(4) << 20;
constexpr std::size_t kMostCaveParts = 50000; ///< elements and attributes

/// The elements of a text, below one that stands for the file. partsLeft: elements and attributes
/// that there may be; less what there are. Throws Failure(kCannotLoad) with the file and the line.
CaveElement parseCave(const std::string& text, const std::string& file, std::size_t& partsLeft);

/// A file and those that it includes, for one host: GLOBAL is unwrapped, LOCAL where its list of
/// hosts has this one.
class CaveFile
{
public:
    /// Included files are looked for beside the one that names them, then in CALVR_CONFIG_DIR.
    /// Throws Failure(kCannotLoad), for what is no regular file and for more than kMostCaveBytes or
    /// kMostCaveParts as well.
    CaveFile(const std::string& file, const std::string& host);

    struct Value
    {
        std::string text;
        const CaveElement* element = nullptr; ///< that has it
    };

    /// path: names of elements from the top, "A.B:2.C"; ":2" asks for name="2". The first element
    /// that has the attribute counts, depth first; then those of included files.
    std::optional<Value> find(const std::string& path,
                              const std::string& attribute = "value") const;

    /// Throws Failure(kCannotLoad) with file, line, element and attribute if it is no finite
    /// number.
    double number(const std::string& path, const std::string& attribute, double otherwise) const;

    /// The same for what is no whole number, or outside of the range.
    int integer(const std::string& path, const std::string& attribute, int otherwise, int least,
                int most) const;

    /// "on" and "true" in any case are true, everything else is false.
    bool flag(const std::string& path, const std::string& attribute, bool otherwise) const;

    std::string text(const std::string& path, const std::string& attribute,
                     const std::string& otherwise) const;

    const std::string& name() const { return _roots.front().file; }

private:
    void load(const std::string& file, const std::string& host);

    std::deque<CaveElement> _roots; ///< a file each
    std::size_t _bytesLeft = kMostCaveBytes, _partsLeft = kMostCaveParts;
};

} // namespace osgRayTrace::app
