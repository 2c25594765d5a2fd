# Settings of pip, to be sourced in the root of the project: no questions, and the certificates of the system instead of
# pip's own ones. They are also right behind the proxy of a company.
export PIP_NO_INPUT=1 PIP_DISABLE_PIP_VERSION_CHECK=1
for certificates in "$PWD/build/certificates.crt" /etc/ssl/certs/ca-certificates.crt; do
  [ ! -r "$certificates" ] || export PIP_CERT=${PIP_CERT:-$certificates}
done
