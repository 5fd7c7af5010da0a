// Rows.cpp - prints rows, and writes them as JSON. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/Rows.h"

#include "apps/common/Interruption.h"
#include "apps/common/Output.h"

#include <nlohmann/json.hpp>

#include <cstdio>

namespace osgRayTrace::bench
{

bool Row::meets() const
{
    switch (goal)
    {
    case Goal::None:
        return true;
    case Goal::AtLeast:
        return value >= bound;
    case Goal::AtMost:
        return value <= bound;
    }
    return true;
}

void endIfInterrupted()
{
    if (app::isInterrupted()) throw Interrupted();
}

void Rows::push_back(Row row)
{
    _list.push_back(std::move(row));
    endIfInterrupted();
}

void printRows(const Rows& rows)
{
    for (const Row& row : rows.list())
    {
        std::printf("%-58s %12.4g %-14s", row.name.c_str(), row.value, row.unit.c_str());
        if (row.goal != Goal::None)
            std::printf(" %s %-8g %s", row.goal == Goal::AtLeast ? ">=" : "<=", row.bound,
                        row.meets() ? "yes" : "NO");
        std::printf("\n");
    }
}

void writeRows(const Rows& rows, const std::string& file)
{
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Row& row : rows.list())
    {
        nlohmann::ordered_json entry{{"name", row.name}, {"value", row.value}, {"unit", row.unit}};
        entry["goal"] = nullptr;
        if (row.goal != Goal::None)
            entry["goal"] =
                (row.goal == Goal::AtLeast ? ">= " : "<= ") + nlohmann::json(row.bound).dump();
        entry["meets"] = row.meets();
        list.push_back(entry);
    }
    app::writeText(file, nlohmann::ordered_json{{"rows", list}}.dump(2) + "\n");
}

} // namespace osgRayTrace::bench
