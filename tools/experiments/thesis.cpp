#include "thesis.h"

#include <array>
#include <map>

namespace thesis {

const std::vector<Aerial>& aerial()
{
    static const std::vector<Aerial> all = {{50000, 0.0180}, {100000, 0.0340}, {500000, 0.1692}, {1000000, 0.3420}};
    return all;
}

const std::vector<Collision>& collision()
{
    static const std::vector<Collision> all = {
        {"box", "cubes", 212.6}, {"box", "balls", 217.8}, {"hull", "cubes", 203.6}, {"hull", "balls", 223.0}};
    return all;
}

const std::vector<Raster>& raster(int test)
{
    static const std::map<int, std::vector<Raster>> all = {
        {3,
         {{0.5, 187374200, 1735798, 260086, 363.4, 187374187},
          {1, 23594090, 217802, 32467, 47.4, 23594094},
          {1.5, 7028028, 68606, 10392, 14.0, 7028028},
          {2, 2961047, 30795, 4817, 6.6, 2961047}}},
        {4,
         {{1, 132814100, 538963, 575878, 161.5, 132814080},
          {1.5, 39383060, 125019, 166763, 41.8, 39383064},
          {2, 16846120, 73634, 66804, 20.6, 16846121},
          {2.5, 8684577, 40121, 40141, 10.9, 8684577}}},
        {5,
         {{0.5, 1002001, 895994, 104006, 114.7, 1002001},
          {1, 251001, 223985, 26015, 28.6, 251001},
          {1.5, 111556, 99990, 11566, 12.6, 111556},
          {2, 63001, 55980, 6520, 7.2, 63001}}},
        {6,
         {{1, 1639680, 618089, 582852, 100.2, 1639680},
          {1.5, 729316, 275742, 258768, 45.1, 729316},
          {2, 410881, 154688, 145070, 24.5, 410881},
          {2.5, 263169, 99228, 92759, 16.7, 263169}}},
    };
    return all.at(test);
}

Random random_search(int test) { return test == 7 ? Random{18.8, 1.03} : Random{42.6, 3.05}; }

double goal(int test)
{
    constexpr std::array<double, 8> times{30, 100, 100, 100, 200, 200, 40, 40};
    return times.at(std::size_t(test - 1));
}

}  // namespace thesis
