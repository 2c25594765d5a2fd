# Debian packages; tools/install-dependencies.sh names them.
find_package(Threads REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(fcl REQUIRED)
find_package(octomap REQUIRED)
find_package(assimp REQUIRED)
find_package(OpenCV REQUIRED COMPONENTS core imgproc)
find_package(CLI11 REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(tinyxml2 REQUIRED)
find_package(sdformat12 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(PNG REQUIRED)
find_package(TIFF REQUIRED)
find_package(PROJ REQUIRED CONFIG)
find_package(ZLIB REQUIRED)
find_package(TBB REQUIRED)
find_package(sdformat12 REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(urdfdom REQUIRED IMPORTED_TARGET urdfdom)
pkg_check_modules(qhull REQUIRED IMPORTED_TARGET qhull_r)
pkg_check_modules(xxhash REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(deflate REQUIRED IMPORTED_TARGET libdeflate)
pkg_check_modules(ccd REQUIRED IMPORTED_TARGET ccd)

set(SPAWNFIELD_PRIVATE_LIBRARIES
  fcl PkgConfig::ccd octomap octomath assimp::assimp opencv_core opencv_imgproc yaml-cpp tinyxml2::tinyxml2
  nlohmann_json::nlohmann_json PNG::PNG TIFF::TIFF ZLIB::ZLIB TBB::tbb PkgConfig::urdfdom PkgConfig::qhull PkgConfig::xxhash PkgConfig::deflate
  Threads::Threads)
