# cmake -DINPUT=file -DOUTPUT=file.cpp -DNAME=viewer_page -P embed.cmake: the bytes of a file as an array,
# blum::cli::NAME_bytes, and their number, NAME_size.
file(READ ${INPUT} bytes HEX)
string(LENGTH "${bytes}" digits)
math(EXPR size "${digits} / 2")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
file(WRITE ${OUTPUT} "#include <cstddef>
namespace blum::cli {
extern const unsigned char ${NAME}_bytes[];
extern const std::size_t ${NAME}_size;
const unsigned char ${NAME}_bytes[] = {${bytes}};
const std::size_t ${NAME}_size = ${size};
}  // namespace blum::cli
")
