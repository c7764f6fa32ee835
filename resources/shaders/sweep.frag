#version 330
// Only depths are wanted.
void main() {
}
