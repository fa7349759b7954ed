export PATH="$PATH:/usr/local/natinst/bin"
