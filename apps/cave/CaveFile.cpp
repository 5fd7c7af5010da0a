// CaveFile.cpp - blocks for hosts, included files, and the look-up. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/cave/CaveFile.h"

#include "apps/cave/PathStep.h"
#include "apps/common/Failure.h"
#include "osgRayTrace/base/NumberText.h"
#include "osgRayTrace/base/TextFile.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <sstream>

namespace osgRayTrace::app
{

namespace
{

constexpr std::size_t kMostFiles = 64;

[[noreturn]] void failAt(const CaveElement& element, const std::string& message)
{
    throw Failure(kCannotLoad, element.file + ":" + std::to_string(element.line) + ": <" +
                                   element.name + ">" + message);
}

bool hasHost(const std::string& hosts, const std::string& host)
{
    std::istringstream list(hosts);
    for (std::string one; std::getline(list, one, ',');)
        if (one == host) return true;
    return false;
}

/// Unwraps blocks with this name: children of blocks that are kept go to the end of parent.
template <class Keeps> void unwrap(CaveElement& parent, const char* name, const Keeps& keeps)
{
    std::deque<CaveElement> left = std::move(parent.children);
    parent.children.clear();
    for (; !left.empty(); left.pop_front())
    {
        CaveElement& child = left.front();
        if (child.name != name)
        {
            unwrap(child, name, keeps);
            parent.children.push_back(std::move(child));
            continue;
        }
        std::deque<CaveElement> inner = std::move(child.children);
        if (keeps(child)) std::move(inner.begin(), inner.end(), std::back_inserter(left));
    }
}

/// Takes the includes out of parent, in the order of the file.
void takeIncludes(CaveElement& parent, std::vector<CaveElement>& includes)
{
    std::deque<CaveElement> all = std::move(parent.children);
    parent.children.clear();
    for (CaveElement& child : all)
    {
        if (child.name == "INCLUDE")
        {
            includes.push_back(std::move(child));
            continue;
        }
        takeIncludes(child, includes);
        parent.children.push_back(std::move(child));
    }
}

std::string trimmed(const std::string& text)
{
    const auto first = text.find_first_not_of(" \t\r\n");
    if (first == std::string::npos) return "";
    return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

std::string includedFile(const CaveElement& include)
{
    const std::string name = trimmed(include.text);
    if (name.empty()) failAt(include, " names no file");
    const std::filesystem::path beside = std::filesystem::path(include.file).parent_path() / name;
    if (std::filesystem::exists(beside)) return beside.string();
    const char* folder = std::getenv("CALVR_CONFIG_DIR");
    const std::filesystem::path other = std::filesystem::path(folder ? folder : "") / name;
    if (folder && std::filesystem::exists(other)) return other.string();
    failAt(include, ": there is no file " + name);
}

bool matches(const CaveElement& element, const Step& step)
{
    if (element.name != step.element) return false;
    if (!step.hasName) return true;
    const std::string* name = element.attribute("name");
    return name && *name == step.name;
}

/// Finds an element depth first; other ways are tried if one leads to nothing.
const CaveElement* findBelow(const CaveElement& parent, const std::vector<Step>& steps,
                             std::size_t step, const std::string& attribute)
{
    for (const CaveElement& child : parent.children)
    {
        if (!matches(child, steps[step])) continue;
        if (step + 1 == steps.size())
        {
            if (child.attribute(attribute)) return &child;
            continue;
        }
        if (const CaveElement* found = findBelow(child, steps, step + 1, attribute)) return found;
    }
    return nullptr;
}

} // namespace

const std::string* CaveElement::attribute(const std::string& attributeName) const
{
    for (const auto& [key, value] : attributes)
        if (key == attributeName) return &value;
    return nullptr;
}

CaveFile::CaveFile(const std::string& file, const std::string& host)
{
    load(file, host);
}

void CaveFile::load(const std::string& file, const std::string& host)
{
    const engine::FileText read = engine::readTextFile(file, kMostCaveBytes);
    if (!read.error.empty()) throw Failure(kCannotLoad, "cannot read " + file + ": " + read.error);
    if (read.text.size() > _bytesLeft)
        throw Failure(kCannotLoad, "cannot read " + file +
                                       ": with the files before it there are "
                                       "more than " +
                                       std::to_string(kMostCaveBytes) + " bytes");
    _bytesLeft -= read.text.size();
    CaveElement root = parseCave(read.text, file, _partsLeft);
    unwrap(root, "COCONFIG", [](const CaveElement&) { return true; });
    unwrap(root, "GLOBAL", [](const CaveElement&) { return true; });
    unwrap(root, "LOCAL",
           [&host](const CaveElement& block)
           {
               const std::string* hosts = block.attribute("host");
               return hosts && hasHost(*hosts, host);
           });
    std::vector<CaveElement> includes;
    takeIncludes(root, includes);
    _roots.push_back(std::move(root));
    for (const CaveElement& include : includes)
    {
        const std::string name = includedFile(include);
        if (_roots.size() >= kMostFiles)
            failAt(include, ": too many files, or one that includes itself");
        load(name, host);
    }
}

std::optional<CaveFile::Value> CaveFile::find(const std::string& path,
                                              const std::string& attribute) const
{
    std::vector<Step> steps;
    std::istringstream names(path);
    for (std::string step; std::getline(names, step, '.');)
        steps.emplace_back(step);
    for (const CaveElement& root : _roots)
        if (const CaveElement* element = findBelow(root, steps, 0, attribute))
            return Value{*element->attribute(attribute), element};
    return std::nullopt;
}

double CaveFile::number(const std::string& path, const std::string& attribute,
                        double otherwise) const
{
    const auto value = find(path, attribute);
    if (!value) return otherwise;
    const auto number = engine::parseNumber<double>(trimmed(value->text));
    if (!number || !std::isfinite(*number))
        failAt(*value->element, ": " + attribute + "=\"" + value->text + "\" is no number");
    return *number;
}

int CaveFile::integer(const std::string& path, const std::string& attribute, int otherwise,
                      int least, int most) const
{
    const double value = number(path, attribute, otherwise);
    if (value == std::floor(value) && value >= least && value <= most)
        return static_cast<int>(value);
    const auto found = find(path, attribute);
    if (!found) return otherwise;
    failAt(*found->element, ": " + attribute + "=\"" + found->text + "\" is not from " +
                                std::to_string(least) + " to " + std::to_string(most));
}

bool CaveFile::flag(const std::string& path, const std::string& attribute, bool otherwise) const
{
    const auto value = find(path, attribute);
    if (!value) return otherwise;
    std::string text = trimmed(value->text);
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text == "on" || text == "true";
}

std::string CaveFile::text(const std::string& path, const std::string& attribute,
                           const std::string& otherwise) const
{
    const auto value = find(path, attribute);
    return value ? value->text : otherwise;
}

} // namespace osgRayTrace::app
