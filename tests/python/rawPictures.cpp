// rawPictures.cpp - renders a model as a C++ program does, and writes the bytes of its images.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/Renderer>

#include <osgDB/ReadFile>

#include <fstream>
#include <iostream>
#include <string>

namespace
{

bool write(const void* bytes, std::size_t size, const std::string& file)
{
    std::ofstream stream(file, std::ios::binary);
    stream.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
    return bool(stream);
}

bool write(const osg::Image* image, const std::string& file)
{
    return image && write(image->data(), image->getTotalSizeInBytes(), file);
}

bool write(const osg::Matrixd& matrix, const std::string& file)
{
    return write(matrix.ptr(), 16 * sizeof(double), file);
}

} // namespace

/// rawPictures MODEL FOLDER WIDTH HEIGHT [OPTION VALUE]...: FOLDER/color, display and a file for
/// each channel, row 0 at the bottom; view and projection: the matrices of OSG. The view is from
/// (1, -9, 4) to (0, 0, 1), 40 degrees.
int main(int argc, char** argv)
{
    if (argc < 5) return 1;
    const std::string folder = std::string(argv[2]) + "/";
    const int width = std::stoi(argv[3]), height = std::stoi(argv[4]);
    const osg::ref_ptr<osgRayTrace::Renderer> renderer = new osgRayTrace::Renderer;
    const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(argv[1]);
    renderer->setScene(scene);
    renderer->setSize(width, height);
    renderer->setViewMatrix(osg::Matrixd::lookAt(
        osg::Vec3d(1.0, -9.0, 4.0), osg::Vec3d(0.0, 0.0, 1.0), osg::Vec3d(0.0, 0.0, 1.0)));
    renderer->setProjectionMatrix(
        osg::Matrixd::perspective(40.0, double(width) / height, 1.0, 100.0));
    for (int i = 5; i + 1 < argc; i += 2)
        if (!renderer->getSettings()->set(argv[i], argv[i + 1])) return 2;
    if (!renderer->render())
    {
        std::cerr << renderer->getStatistics().message << '\n';
        return 3;
    }
    bool written = write(renderer->getColorImage(), folder + "color") &&
                   write(renderer->getDisplayImage(), folder + "display") &&
                   write(renderer->getViewMatrix(), folder + "view") &&
                   write(renderer->getProjectionMatrix(), folder + "projection");
    for (const char* name : {"depth", "distance", "normal", "albedo", "position", "id", "error"})
        written = written && write(renderer->getChannelImage(name), folder + name);
    return written ? 0 : 4;
}
