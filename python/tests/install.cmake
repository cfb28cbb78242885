# The installed package is found, and whole: -DBUILD= -DPYTHON= -DWORK= [-DFOLDER=]
file(REMOVE_RECURSE ${WORK})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}
                COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET) # the shared libraries, too
file(GLOB module ${WORK}/lib/python3*/*-packages/relief/_relief*.so ${WORK}/${FOLDER}/relief/_relief*.so)
list(LENGTH module count)
if(count EQUAL 0)
  message(FATAL_ERROR "no module in ${WORK}/lib/python3*/*-packages/relief")
endif()
list(GET module 0 module)
cmake_path(GET module PARENT_PATH folder)
foreach(file __init__.py __init__.pyi py.typed)
  if(NOT EXISTS ${folder}/${file})
    message(FATAL_ERROR "${file} is not in ${folder}")
  endif()
endforeach()
cmake_path(GET folder PARENT_PATH folder)
execute_process(COMMAND ${CMAKE_COMMAND} -E env PYTHONPATH=${folder} PYTHONDONTWRITEBYTECODE=1
                ${PYTHON} -c "import relief; print(relief.__file__, relief.__version__, relief.World())"
                WORKING_DIRECTORY ${WORK} COMMAND_ERROR_IS_FATAL ANY)
