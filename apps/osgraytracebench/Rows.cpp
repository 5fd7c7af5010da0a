// Rows.cpp - the result of a benchmark: rows for people and for programs. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/Rows.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <filesystem>
#include <fstream>

namespace osgRayTrace::bench
{

bool Row::meets() const
{
    switch (goal)
    {
    case Goal::None: return true;
    case Goal::AtLeast: return value >= bound;
    case Goal::AtMost: return value <= bound;
    }
    return true;
}

void printRows(const Rows& rows)
{
    for (const Row& row : rows)
    {
        std::printf("%-58s %12.4g %-14s", row.name.c_str(), row.value, row.unit.c_str());
        if (row.goal != Goal::None)
            std::printf(" %s %-8g %s", row.goal == Goal::AtLeast ? ">=" : "<=", row.bound,
                        row.meets() ? "yes" : "NO");
        std::printf("\n");
    }
}

bool canWriteRows(const std::string& file)
{
    const std::string part = file + ".part";
    if (std::filesystem::is_directory(file) || !std::ofstream(part)) return false;
    return std::remove(part.c_str()) == 0;
}

bool writeRows(const Rows& rows, const std::string& file)
{
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Row& row : rows)
    {
        nlohmann::ordered_json entry{{"name", row.name}, {"value", row.value}, {"unit", row.unit}};
        entry["goal"] = nullptr;
        if (row.goal != Goal::None)
            entry["goal"] = (row.goal == Goal::AtLeast ? ">= " : "<= ") + nlohmann::json(row.bound).dump();
        entry["meets"] = row.meets();
        list.push_back(entry);
    }
    const std::string part = file + ".part";
    {
        std::ofstream stream(part);
        stream << nlohmann::ordered_json{{"rows", list}}.dump(2) << "\n";
        if (!stream) return false;
    }
    return std::rename(part.c_str(), file.c_str()) == 0;
}

} // namespace osgRayTrace::bench
