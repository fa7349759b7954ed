export PATH="$PATH:/usr/local/frc/bin"
