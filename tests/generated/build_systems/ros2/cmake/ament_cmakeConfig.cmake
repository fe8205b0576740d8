function(ament_package)
endfunction()
