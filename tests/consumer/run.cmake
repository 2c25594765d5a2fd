# Checks that docs/library.md shows the programs of this folder as they are, except errors.cpp. Then installs into an
# empty prefix, builds them against the package there, runs them and checks what they print.
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "this command failed with status ${status}: ${ARGN}")
  endif()
endfunction()

# Runs a program and checks that it ends with `status` and prints lines that match `pattern`, nothing else.
function(expect status pattern)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE got OUTPUT_VARIABLE out ERROR_VARIABLE err)
  if(NOT got EQUAL status OR NOT "${out}${err}" MATCHES "^${pattern}$")
    message(FATAL_ERROR "${ARGN}\nends with ${got} and prints\n${out}${err}\nneeds ${status} and ${pattern}")
  endif()
endfunction()

file(READ ${SOURCE}/../../docs/library.md docs)
foreach(program sample check scene robot planner)
  file(READ ${SOURCE}/${program}.cpp text)
  string(FIND "${docs}" "```cpp\n${text}```\n" found)
  if(found EQUAL -1)
    message(FATAL_ERROR "docs/library.md does not show ${program}.cpp as it is")
  endif()
endforeach()

set(flags "")
if(SANITIZE)
  set(flags "-fsanitize=${SANITIZE}")
endif()
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -G Ninja -DCMAKE_PREFIX_PATH=${WORK}/prefix
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS=${flags})
run(${CMAKE_COMMAND} --build ${WORK}/build)

set(maps ${WORK}/prefix/share/spawnfield/maps)
set(husky ${maps}/robots/husky.yaml)
run(${WORK}/prefix/bin/spawnfield bake ${maps}/training/scene.yaml -o ${WORK}/map --resolution 0.2 --quiet)
file(WRITE ${WORK}/poses.csv "x,y,z,yaw\n0,3,0.1,0\n-6.5,-5,0.1,0\n7,-7,0.1,0\n0,3,2.5,0\n")
set(program ${WORK}/build)
set(n "-?[0-9.]+")
expect(0 "(${n} ${n} ${n}, roll ${n}, pitch ${n}, yaw ${n}\n)+" ${program}/sample ${WORK}/map ${husky})
expect(0 "-6.5 -5: collision with thin_wall\n7 -7: submerged\n0 3: aerial: 2.55 m above the ground, [^\n]*\n"
  ${program}/check ${WORK}/map ${husky} ${WORK}/poses.csv)
expect(1 "check: ${WORK}/nothing: .*\n" ${program}/check ${WORK}/nothing ${husky} ${WORK}/poses.csv)
# 49 poses: the robot's box overlaps the crate where |x - 2| < 0.995 and |y| < 0.835, which are 7 x 7 steps of 0.25 m.
expect(0 "collision: 49\nvalid: 1632\n" ${program}/scene)
expect(0 "5 spawns, 0 m above the ground\n" ${program}/robot ${WORK}/map)
expect(0 "valid: [0-9]+ and [0-9]+ of 20000; [0-9.]+ us per pose and thread\n"
  ${program}/planner ${WORK}/map ${husky} 20000)

# The modules' errors have the types of the library.
file(WRITE ${WORK}/damaged.ply "ply\n")
expect(0 "${WORK}/damaged.ply: [^\n]*\nwrite_heatmap: pixels is 199, needs 200 .. 16000\nmissing/a.png: [^\n]*\n"
  ${program}/errors ${WORK}/damaged.ply)

# The program starts without the libraries of the modules, and a missing module is named when it is needed.
execute_process(COMMAND ldd ${WORK}/prefix/bin/spawnfield OUTPUT_VARIABLE libraries COMMAND_ERROR_IS_FATAL ANY)
if(libraries MATCHES "assimp|fcl|hpdf|opencv|libproj|sdformat|not found")
  message(FATAL_ERROR "spawnfield must start without the libraries of its modules, but needs\n${libraries}")
endif()
file(GLOB modules ${WORK}/prefix/lib*/libspawnfield_*.so ${WORK}/prefix/lib/*/libspawnfield_*.so)
file(REMOVE ${modules})
expect(0 "[^\n]+\n.*" ${WORK}/prefix/bin/spawnfield info ${WORK}/map)
expect(1 "another error: mesh files cannot be read: [^\n]*libspawnfield_mesh_reader.so cannot be loaded: [^\n]*\n"
  ${program}/errors ${WORK}/damaged.ply)

# A module of another version is refused.
list(GET modules 0 module)
cmake_path(GET module PARENT_PATH folder)
file(COPY ${program}/libspawnfield_mesh_reader.so DESTINATION ${folder})
set(refused "[^\n]*libspawnfield_mesh_reader.so has version 0.1.0, needs [0-9.]+; [^\n]*\n")
expect(1 "another error: mesh files cannot be read: ${refused}" ${program}/errors ${WORK}/damaged.ply)
