# A stranger's targets with the names of system libraries. Whoever links one of them by mistake does
# not link at all.
foreach(name m dl c rt pthread z png png16 jpeg turbojpeg jansson zstd lz4 bz2 qhull qhullstatic_r
        qhull_r avcodec avformat avutil swscale pipewire epoxy EGL GL glfw udev stdc++ gcc files models hulls mcap video)
  add_library(${name} INTERFACE)
  target_link_libraries(${name} INTERFACE -lthis-is-the-strangers-own-${name})
endforeach()
