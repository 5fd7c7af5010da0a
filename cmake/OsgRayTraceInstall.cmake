# The installed, exported package: find_package(osgRayTrace).
