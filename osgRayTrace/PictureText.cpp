// PictureText.cpp - names and values of all that decides on a pass. Layer: public API, private.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/PictureText.h"

#include <osgRayTrace/Version>

#include "osgRayTrace/accel/EmbreeVersion.h"
#include "osgRayTrace/base/Cpu.h"
#include "osgRayTrace/base/NumberText.h"
#include "osgRayTrace/scene/Scene.h"
#include "osgRayTrace/scene/SceneDigest.h"

#include <charconv>

namespace osgRayTrace
{

namespace
{

std::string hexadecimal(uint64_t value)
{
    char digits[16];
    const auto end = std::to_chars(digits, digits + sizeof digits, value, 16).ptr;
    return std::string(digits, end);
}

std::string textOf(const osg::Matrixd& matrix)
{
    std::string text;
    for (int i = 0; i < 16; ++i)
        text += (i > 0 ? " " : "") + engine::numberText(matrix.ptr()[i]);
    return text;
}

} // namespace

std::string pictureText(const PictureInputs& picture)
{
    std::string text;
    const auto add = [&text](const std::string& name, const std::string& value)
    { text += name + ' ' + value + '\n'; };
    add("osgRayTrace", osgRayTraceGetVersion());
    add("embree", engine::embreeVersion());
    add("processor", engine::cpuLevel());
    add("size", std::to_string(picture.width) + ' ' + std::to_string(picture.height));
    add("view", textOf(picture.view));
    add("projection", textOf(picture.projection));
    for (const char* option : kPictureOptions)
        add(option, picture.settings.get(option));
    add("scene", hexadecimal(engine::sceneDigest(picture.scene)));
    if (!picture.shutterEnd.empty()) add("shutter", picture.shutterEnd);
    return text;
}

} // namespace osgRayTrace
