# Run at install: copies `headers` of the folder `from` to the folder `to`; "folder/name.hpp" becomes <weir/folder/name.hpp>, so that nothing
# but weir/ has to be on a user's search path.
if(NOT IS_ABSOLUTE "${to}")
  set(to "${CMAKE_INSTALL_PREFIX}/${to}")
endif()
foreach(header ${headers})
  file(READ "${from}/${header}" text)
  string(REGEX REPLACE "#include \"([a-z_]+/[a-z_]+\\.hpp)\"" "#include <weir/\\1>" text "${text}")
  message(STATUS "Installing: $ENV{DESTDIR}${to}/${header}")
  file(WRITE "$ENV{DESTDIR}${to}/${header}" "${text}")
endforeach()
