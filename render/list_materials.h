#pragma once

/// Prints all measured media to stdout, as a table or as JSON.
void listMaterials(bool json);
