// ComparePictures.cpp - tells by how much two pictures differ, and draws the difference.
// Layer: tests.
// SPDX-License-Identifier: MIT
//
// Usage: comparePictures A B DIFFERENCE. It prints the mean absolute difference of RGB in units of
// 1/255, and "blank" after it if A has only one colour. It writes the picture DIFFERENCE: four
// times the absolute difference. The exit code is 1 if the pictures cannot be compared.
#include <osg/Image>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <iostream>

namespace
{

bool isRgb(const osg::Image* image)
{
    return image && image->getPixelFormat() == GL_RGB && image->getDataType() == GL_UNSIGNED_BYTE;
}

bool isBlank(const osg::Image& image)
{
    for (int y = 0; y < image.t(); ++y)
        for (int x = 0; x < image.s(); ++x)
            if (std::memcmp(image.data(unsigned(x), unsigned(y)), image.data(), 3)) return false;
    return true;
}

/// Returns the mean difference of the values; the picture of the differences has the size of both.
double draw(const osg::Image& a, const osg::Image& b, osg::Image& differences)
{
    double sum = 0.0;
    for (int y = 0; y < a.t(); ++y)
        for (int i = 0; i < 3 * a.s(); ++i)
        {
            const unsigned int row = unsigned(y);
            const int difference = std::abs(int(a.data(0, row)[i]) - int(b.data(0, row)[i]));
            sum += difference;
            differences.data(0, row)[i] = (unsigned char)(std::min(255, 4 * difference));
        }
    return sum / (3.0 * a.s() * a.t());
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 4) return 1;
    const osg::ref_ptr<osg::Image> a = osgDB::readRefImageFile(argv[1]);
    const osg::ref_ptr<osg::Image> b = osgDB::readRefImageFile(argv[2]);
    if (!isRgb(a.get()) || !isRgb(b.get()) || a->s() != b->s() || a->t() != b->t())
    {
        std::cerr << argv[1] << ", " << argv[2] << ": not two pictures of one size in RGB\n";
        return 1;
    }
    const osg::ref_ptr<osg::Image> differences = new osg::Image;
    differences->allocateImage(a->s(), a->t(), 1, GL_RGB, GL_UNSIGNED_BYTE);
    std::cout << draw(*a, *b, *differences) << (isBlank(*a) ? " blank" : "") << '\n';
    return osgDB::writeImageFile(*differences, argv[3]) ? 0 : 1;
}
