// Headers that most test files include. They are compiled once.
#include "catch.h"

#include <spawnfield/error.h>
#include <spawnfield/query.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <set>
#include <sstream>
