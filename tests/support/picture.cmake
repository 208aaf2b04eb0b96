# mesh-picture writes a PNG of the wished size, the same every time, and its exit codes are right.
function(expect code)
  execute_process(COMMAND ${PICTURE} ${ARGN} RESULT_VARIABLE got OUTPUT_QUIET ERROR_VARIABLE message)
  if(NOT got EQUAL code)
    message(FATAL_ERROR "mesh-picture ${ARGN}: exit code ${got}, expected ${code}\n${message}")
  endif()
endfunction()

set(png ${WORK}/picture.png)
expect(0 ${MESH} ${MESH} -o ${png} --width 320 --height 200 --titles "one,two" --edges)
file(READ ${png} head LIMIT 24 HEX)
# Signature, length and name of the first chunk, 320 × 200.
if(NOT head STREQUAL "89504e470d0a1a0a0000000d4948445200000140000000c8")
  message(FATAL_ERROR "no PNG of 320 x 200: ${head}")
endif()
expect(0 ${MESH} ${MESH} -o ${png}.again --width 320 --height 200 --titles "one,two" --edges)
execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${png} ${png}.again
                COMMAND_ERROR_IS_FATAL ANY)

expect(0 --help)
expect(2)
expect(2 ${MESH})
expect(2 ${MESH} -o ${png} --no-such-option)
expect(2 ${MESH} -o ${png} --view nonsense)
expect(2 ${MESH} -o ${png} --titles "one,two")
expect(2 ${MESH} -o ${png} --colours mauve)
expect(3 ${WORK}/absent.obj -o ${png})
expect(4 ${MESH} -o ${WORK}/absent/picture.png)
