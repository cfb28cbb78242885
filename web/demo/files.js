// Recordings that are dropped or chosen. They are read in this tab, and go nowhere.
export function takeFiles(drop, input, onFile) {
  const hasFiles = (event) => event.dataTransfer?.types.includes('Files');
  let depth = 0; // dragenter and dragleave come for every element under the pointer
  const show = (change) => {
    depth = Math.max(0, depth + change);
    drop.hidden = depth === 0;
  };
  window.addEventListener('dragenter', (event) => { if (hasFiles(event)) show(1); });
  window.addEventListener('dragleave', (event) => { if (hasFiles(event)) show(-1); });
  window.addEventListener('dragover', (event) => { if (hasFiles(event)) event.preventDefault(); });
  window.addEventListener('drop', (event) => {
    if (!hasFiles(event)) return;
    event.preventDefault();
    show(-depth);
    onFile(event.dataTransfer.files[0]);
  });
  input.addEventListener('change', () => {
    if (input.files.length > 0) onFile(input.files[0]);
    input.value = '';
  });
}
