// The same script runs in the page and in its worker, so that the page stays one file.
import { answerTreeRequests } from './bvh_worker.js';
import { startPage } from './app.js';

if (typeof document === 'undefined') answerTreeRequests();
else startPage(document.currentScript.textContent);
