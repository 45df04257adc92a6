# The notices of the libraries in a bundle, which their licences want beside them: share/doc/PACKAGE/copyright.
#
# Each library came from a package of this machine, which dpkg names. `architecture` ("x86_64-linux-gnu") tells
# it from those of other architectures.
get_filename_component(root "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}" ABSOLUTE)  # a prefix may be relative
file(GLOB libraries RELATIVE ${root}/lib ${root}/lib/*.so*)
if(NOT libraries)
  message(FATAL_ERROR "the bundle in ${root} has no libraries")
endif()
list(TRANSFORM libraries PREPEND "*/")
find_program(DPKG dpkg NO_CACHE)
if(NOT DPKG)
  message(WARNING "there is no dpkg: the bundle has no notices of its libraries")
  return()
endif()
execute_process(COMMAND ${DPKG} -S ${libraries} OUTPUT_VARIABLE owners ERROR_VARIABLE unowned)
if(unowned)
  message(WARNING "of no package, so without a notice: ${unowned}")
endif()
string(REGEX MATCHALL "[a-z0-9.+-]+(:[a-z0-9]+)?: [^\n]*/${architecture}/[^\n]*" owners "${owners}")
list(TRANSFORM owners REPLACE ":.*" "")
list(REMOVE_DUPLICATES owners)
foreach(package ${owners})
  set(notice /usr/share/doc/${package}/copyright)
  if(NOT EXISTS ${notice})
    message(WARNING "${package} is installed without its notice: the bundle lacks it")
    continue()
  endif()
  file(REAL_PATH ${notice} notice)  # packages of one source share it by links
  file(MAKE_DIRECTORY ${root}/share/doc/${package})
  file(COPY_FILE ${notice} ${root}/share/doc/${package}/copyright)
endforeach()
