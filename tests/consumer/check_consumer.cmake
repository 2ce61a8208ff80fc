# Installs rom, moves the installation and uses it from the project beside this file, where MPI, PETSc and CGAL cannot be
# found:
#   cmake -DSOURCE=... -DBUILD=... -DSCRATCH=... -DGENERATOR=... -P check_consumer.cmake
# BUILD: a build tree that holds rom, the whole project's or that of rom alone.
set(hide "")
foreach(package MPI PETSc SLEPc CGAL PkgConfig tomlplusplus CLI11 spdlog nlohmann_json muparser GTest)
  list(APPEND hide -DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
set(common --no-warn-unused-cli -G ${GENERATOR} -DCMAKE_BUILD_TYPE=Release)

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# 1. rom is configured alone. Where HDF5 is the parallel one, its header asks for mpi.h, and only then MPI is looked for.
file(REMOVE_RECURSE ${SCRATCH})
set(hide_for_rom ${hide})
list(REMOVE_ITEM hide_for_rom -DCMAKE_DISABLE_FIND_PACKAGE_MPI=ON)
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${SCRATCH}/rom ${common} -DUNDULA_ROM_ONLY=ON ${hide_for_rom})

# 2. It is installed, and does not depend on where.
run(${CMAKE_COMMAND} --install ${BUILD} --component rom --prefix ${SCRATCH}/installed)
file(RENAME ${SCRATCH}/installed ${SCRATCH}/moved)

# 3. A project that uses it, and knows nothing of the sources.
run(${CMAKE_COMMAND} -S ${SOURCE}/tests/consumer -B ${SCRATCH}/consumer ${common} ${hide}
    -DCMAKE_PREFIX_PATH=${SCRATCH}/moved -DQUERY_SOURCE=${SOURCE}/apps/examples/1_hq_query.cpp)
run(${CMAKE_COMMAND} --build ${SCRATCH}/consumer)

# 4. Its answers.
run(${SCRATCH}/consumer/careless)
execute_process(COMMAND ${SCRATCH}/consumer/query ${SOURCE}/data/models/wave_pump_fixed.h5
                OUTPUT_VARIABLE answer COMMAND_ERROR_IS_FATAL ANY)
message("${answer}")
if(NOT answer MATCHES "60\\.0 +-3\\.[0-9]+ +0\\.[0-9]+\n$")
  message(FATAL_ERROR "not the head-flow curve that the model gives at 60 mmHg")
endif()
