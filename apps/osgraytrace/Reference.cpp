// Reference.cpp - reads and checks the reference. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Reference.h"

#include "apps/common/ModelFiles.h"

#include <osgDB/Registry>

namespace osgRayTrace::app
{

osg::ref_ptr<osg::Image> readReference(const std::string& file, int width, int height)
{
    osgDB::Registry* registry = osgDB::Registry::instance();
    osgDB::ReaderWriter::ReadResult result = registry->readImage(file, registry->getOptions());
    if (!result.validImage()) throw cannotLoad(file, result);
    const osg::ref_ptr<osg::Image> image = result.getImage();
    const bool rgb = image->getPixelFormat() == GL_RGB || image->getPixelFormat() == GL_RGBA;
    if (!rgb || image->getDataType() != GL_FLOAT)
    {
        throw Failure(kCannotLoad,
                      "the reference " + file + " holds no linear radiance; it must be an .exr");
    }
    if (image->s() != width || image->t() != height)
    {
        throw Failure(kUsage, "the reference " + file + " is of --size " +
                                  std::to_string(image->s()) + " " + std::to_string(image->t()));
    }
    return image;
}

} // namespace osgRayTrace::app
