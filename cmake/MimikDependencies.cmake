# Every library is a Debian 12 package (scripts/setup.sh). Heavy ones are linked PRIVATE by the one folder that uses them.
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB 2021 CONFIG REQUIRED COMPONENTS tbb)
find_package(fmt 9 CONFIG REQUIRED)
find_package(nlohmann_json 3.11 CONFIG REQUIRED)
find_package(PNG REQUIRED)
find_package(nanoflann 1.4 CONFIG REQUIRED)
