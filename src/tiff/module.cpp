#include "base/tiff.h"

SPAWNFIELD_MODULE(tiff, TIFFOpen, TIFFClose, TIFFFlush, TIFFSetErrorHandler, TIFFSetWarningHandler, TIFFSetTagExtender,
                  TIFFMergeFieldInfo, TIFFGetField, TIFFGetFieldDefaulted, TIFFSetField, TIFFReadDirectory,
                  TIFFWriteDirectory, TIFFIsCODECConfigured, TIFFIsTiled, TIFFScanlineSize, TIFFReadScanline,
                  TIFFTileSize, TIFFReadTile, TIFFNumberOfTiles, TIFFGetStrileByteCount, TIFFReadRawTile,
                  TIFFWriteRawTile);
