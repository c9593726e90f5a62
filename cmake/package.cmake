# cpack -G DEB, which ./weir.sh package calls: weir (the command, its cases and tables), weir-view (the programs with a window), libweir-dev
# (the library for find_package), python3-weir. What a package needs of libraries is found out by dpkg-shlibdeps.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME weir)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_VENDOR "The weir developers")
set(WEIR_MAINTAINER "The weir developers <nobody@weir.invalid>" CACHE STRING "Who answers for the packages: name and address")
set(CPACK_PACKAGE_CONTACT "${WEIR_MAINTAINER}")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL weir view library)
if(WEIR_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)

set(about "weir simulates smoke, water, waves and heat by the methods of real-time
graphics, judges each against analytic and published references, and measures
what its accuracy costs.")
set(same "weir (= ${PROJECT_VERSION})")

set(CPACK_DEBIAN_WEIR_PACKAGE_NAME weir)
set(CPACK_COMPONENT_WEIR_DESCRIPTION "fluid simulation by real-time methods, with verified accuracy and measured cost\n${about}\n\nThis package has the command, the cases and the tables of weir plan.")
set(CPACK_DEBIAN_WEIR_PACKAGE_SUGGESTS "weir-view, python3-weir, ffmpeg, gnuplot-nox")

set(CPACK_DEBIAN_VIEW_PACKAGE_NAME weir-view)
set(CPACK_COMPONENT_VIEW_DESCRIPTION "fluid simulation: frames in a window, interactive forcing\n${about}\n\nThis package has the programs with windows: weir view and weir live.")
set(CPACK_DEBIAN_VIEW_PACKAGE_DEPENDS "${same}")

# Static: programs that link it need what it is made of.
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libweir-dev)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS OFF)  # has no dynamic program; CPack would ask `file` about every header
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "fluid simulation: the library of C++\n${about}\n\nThis package has the static library, its headers, and what find_package(weir)\nreads.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS
  "libfmt-dev, libtomlplusplus-dev, libmuparser-dev, libgsl-dev, libfftw3-dev, libsuitesparse-dev, libopenblas-dev, libvtk9-dev, ocl-icd-opencl-dev")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-weir)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "fluid simulation: the module of Python\n${about}\n\nThis package is for Python and NumPy: import weir.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${same}, python3 (>= 3.${weir_python_minor}), python3 (<< 3.${weir_python_next}), python3-numpy")
# What Python has compiled is in no package's list: it goes before its folder does.
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/debian/prerm CONTENT "#!/bin/sh
set -e
rm -rf /usr/lib/python3/dist-packages/weir/__pycache__
")
file(CHMOD ${PROJECT_BINARY_DIR}/debian/prerm PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/debian/prerm)

# What Debian wants beside every package: who may copy it, and what has changed.
set(documents ${PROJECT_BINARY_DIR}/debian)
file(STRINGS ${PROJECT_SOURCE_DIR}/CITATION.cff released REGEX "^date-released: ")
string(REGEX REPLACE ".*: *" "" released "${released}")
execute_process(COMMAND date -R -u -d ${released} OUTPUT_VARIABLE released OUTPUT_STRIP_TRAILING_WHITESPACE)
file(CONFIGURE OUTPUT ${documents}/changelog CONTENT "weir (@PROJECT_VERSION@) unstable; urgency=medium

  * Release @PROJECT_VERSION@; CHANGELOG.md of the source tells what is in it.

 -- @CPACK_PACKAGE_CONTACT@  @released@
")
file(CONFIGURE OUTPUT ${documents}/copyright CONTENT "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: weir

Files: *
Copyright: 2026 The weir developers
License: GPL-3.0-or-later

License: GPL-3.0-or-later
 This program is free software: you can redistribute it and/or modify it under
 the terms of the GNU General Public License as published by the Free Software
 Foundation, either version 3 of the License, or (at your option) any later
 version.
 .
 On Debian systems, the full text of version 3 of the license is in
 /usr/share/common-licenses/GPL-3.
")
execute_process(COMMAND gzip -9 -n -f -k ${documents}/changelog)
foreach(component ${CPACK_COMPONENTS_ALL})
  string(TOUPPER ${component} upper)
  install(FILES ${documents}/changelog.gz ${documents}/copyright COMPONENT ${component}
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
endforeach()
include(CPack)
