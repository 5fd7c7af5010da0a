// Glossiness.cpp - makes an image of roughness from one of glossiness. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/Glossiness.h"

#include <osg/Image>

#include <algorithm>

namespace osgRayTrace::gltf
{

osg::ref_ptr<osg::Texture2D> roughnessOf(const osg::Texture2D& glossiness, float factor)
{
    const osg::Image* from = glossiness.getImage();
    if (!from || !from->data() || from->getPixelFormat() != GL_RGBA ||
        from->getDataType() != GL_UNSIGNED_BYTE)
        return nullptr;
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(from->s(), from->t(), 1, GL_RGB, GL_UNSIGNED_BYTE, 1);
    image->setWriteHint(osg::Image::STORE_INLINE);
    const float share = std::clamp(factor, 0.0f, 1.0f);
    for (int t = 0; t < from->t(); ++t)
        for (int s = 0; s < from->s(); ++s)
        {
            unsigned char* to = image->data(s, t);
            const float gloss = static_cast<float>(from->data(s, t)[3]) * share;
            to[0] = to[2] = 0;
            to[1] = static_cast<unsigned char>(255.5f - gloss);
        }
    const osg::ref_ptr<osg::Texture2D> texture =
        new osg::Texture2D(glossiness, osg::CopyOp::SHALLOW_COPY);
    texture->setImage(image.get());
    return texture;
}

} // namespace osgRayTrace::gltf
